#pragma once
#include <string>
#include <string_view>
#include <vector>

#include "core/sky/stars/star_catalogue.h"

namespace dmise {

/// A catalogue, and each line that could not be used: `file:line: reason`.
struct StarReading {
  StarCatalogue catalogue;  // epoch J2000.0
  std::vector<std::string> problems;

  bool operator==(const StarReading&) const = default;
};

/// Reads a catalogue, whose format is recognised by its first lines; `name` is the file as problems
/// call it. Throws `ConfigError` if nothing can be used: a header without the needed columns, an
/// unknown format, no star at all.
StarReading parse_stars(std::string_view text, const std::string& name);

/// A star of deepstars.dat has this and its place in the file, from 1, as its number.
inline constexpr std::uint32_t first_deep_star_id = 1'000'000;

// One reader per format. To add one: write it beside the others, list it here and in star_file.cpp,
// test it in tests/sky/test_star_file.cpp.

/// KStars' stars.dat, and launch/catalogues/stars.dat.gz: fixed columns, places and motions of
/// J2000.0.
StarReading parse_kstars(std::string_view text, const std::string& name);
/// HYG database: CSV, columns by the names in their header.
StarReading parse_hyg(std::string_view text, const std::string& name);
/// Yale Bright Star Catalogue, 5th edition (CDS V/50): fixed columns.
StarReading parse_bsc5(std::string_view text, const std::string& name);
/// CSV, or ECSV with commas: columns of Gaia's table gaia_source by the names in their header.
StarReading parse_gaia_csv(std::string_view text, const std::string& name);
/// Reads these columns of a FITS binary table.
StarReading parse_gaia_fits(std::string_view bytes, const std::string& name);
/// deepstars.dat of KStars: Tycho-2 from V = 8 on, binary, places of J2000.0.
StarReading parse_deep_stars(std::string_view bytes, const std::string& name);
/// CSV with ra_deg, dec_deg, mag_v and optionally id, bv, pm_ra_mas_per_yr (times cos dec),
/// pm_dec_mas_per_yr, parallax_mas, epoch_jyear (default 2000), in any order.
StarReading parse_star_csv(std::string_view text, const std::string& name);

}  // namespace dmise
