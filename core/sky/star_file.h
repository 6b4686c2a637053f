#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/sky/star_catalogue.h"

namespace dmise {

/// The star catalogues that can be read; all may be gzipped. To add one: list it here and in
/// star_file.cpp, write its `parse_` beside the others, test it in tests/sky/test_star_file.cpp.
enum class StarFormat {
  kstars,  // stars.dat of Debian's kstars-data, fixed columns, place and motion of J2000.0
  hyg,     // HYG database, CSV, columns by header name
  bsc5,    // Yale Bright Star Catalogue, 5th edition (CDS V/50), fixed columns
  deep,    // deepstars.dat of KStars: Tycho-2 from V = 8 on, binary, place of J2000.0
  gaia,    // CSV or ECSV with commas, columns of Gaia's table gaia_source by header name
  fits,    // the same columns in a FITS binary table
  csv,     // ra_deg, dec_deg, mag_v and optionally id, bv, pm_ra_mas_per_yr (times cos dec),
           // pm_dec_mas_per_yr, parallax_mas, epoch_jyear (default 2000), in any order
};

/// A catalogue, and each line that could not be used: `file:line: reason`.
struct StarReading {
  StarCatalogue catalogue;  // epoch J2000.0
  std::vector<std::string> problems;

  bool operator==(const StarReading&) const = default;
};

/// The format by its first lines; none when it looks like none of them.
std::optional<StarFormat> guess_star_format(std::string_view text);

/// Reads a catalogue's text; `name` is the file as problems call it. Throws `ConfigError` when the
/// whole is unusable: a header without the needed columns, an unknown format, no star at
/// all.
StarReading parse_stars(std::string_view text, const std::string& name,
                        std::optional<StarFormat> format = std::nullopt);

/// A star of deepstars.dat has this and its place in the file, from 1, as its number.
inline constexpr std::uint32_t first_deep_star_id = 1'000'000;

// Each format's own reader.
StarReading parse_kstars(std::string_view text, const std::string& name);
StarReading parse_hyg(std::string_view text, const std::string& name);
StarReading parse_bsc5(std::string_view text, const std::string& name);
StarReading parse_gaia_csv(std::string_view text, const std::string& name);
StarReading parse_gaia_fits(std::string_view bytes, const std::string& name);
StarReading parse_deep_stars(std::string_view bytes, const std::string& name);
StarReading parse_star_csv(std::string_view text, const std::string& name);

}  // namespace dmise
