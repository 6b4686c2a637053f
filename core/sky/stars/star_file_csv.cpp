// Star catalogues of comma-separated values, columns by the names in their header.

#include <unordered_set>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/sky/stars/gaia_stars.h"
#include "core/sky/stars/star_file.h"
#include "core/sky/stars/star_text.h"

namespace dmise {

using namespace star_text;

namespace {

/// One row: fields by the place of their name in the list that the reader was given.
struct Row {
  const std::vector<std::string_view>& fields;
  const std::vector<int>& places;

  std::string_view text(std::size_t column) const {
    const int at = places[column];
    return at >= 0 && std::size_t(at) < fields.size() ? fields[std::size_t(at)]
                                                      : std::string_view{};
  }
  std::optional<double> value(std::size_t column) const { return parse_real(text(column)); }
  /// Something stands there that is not a number.
  bool garbled(std::size_t column) const { return !text(column).empty() && !value(column); }
};

/// Calls `use(row, line, count)` for each row; what it returns is the reason why the row can't be
/// used (null: it could). The first `needed` of `names` must be in the header and in every row; the
/// first `numbers` of them are numbers where there is something, the rest is text.
template <class Use>
void for_rows(std::string_view text, const std::string& name,
              const std::vector<std::string_view>& names, std::size_t needed, std::size_t numbers,
              std::vector<std::string>& problems, Use&& use) {
  std::vector<std::string_view> fields;
  std::vector<int> places;
  std::uint32_t count = 0;
  for_lines(text, [&](std::string_view line, int at) {
    if (trimmed(line).empty() || line.front() == '#') return;
    split_csv(line, fields);
    if (places.empty()) {
      places = find_columns(fields, names);
      for (std::size_t i = 0; i < needed; ++i)
        if (places[i] < 0)
          throw ConfigError(at_line(name, at, "the header has no column " + std::string(names[i])));
      return;
    }
    ++count;
    const Row row{fields, places};
    for (std::size_t i = 0; i < numbers; ++i)
      if (i < needed ? !row.value(i) : row.garbled(i)) {
        problems.push_back(at_line(
            name, at,
            std::string(names[i]) + ": must be a number, got '" + std::string(row.text(i)) + "'"));
        return;
      }
    if (const char* why = use(row, count)) problems.push_back(at_line(name, at, why));
  });
}

std::uint32_t id_of(const Row& row, std::size_t column, std::uint32_t count) {
  const double id = row.value(column).value_or(-1.0);
  return id >= 0 && id < 4294967296.0 ? std::uint32_t(id) : count;
}

}  // namespace

// Right ascension in hours, distance in parsec (>= 100000: not known), motions in mas/yr, in RA
// times cos Dec; places of J2000.0. The Sun stands first, at distance 0, and is no star of the
// background.
StarReading parse_hyg(std::string_view text, const std::string& name) {
  enum { ra, dec, mag, id, dist, pm_ra, pm_dec, ci, spect };
  StarReading reading;
  for_rows(text, name, {"ra", "dec", "mag", "id", "dist", "pmra", "pmdec", "ci", "spect"}, 3, 8,
           reading.problems, [&](const Row& row, std::uint32_t count) -> const char* {
             if (*row.value(mag) < -20) return nullptr;  // Sol
             StarRecord star{.id = id_of(row, id, count)};
             star.ra_rad = *row.value(ra) * 15 * deg;
             star.dec_rad = *row.value(dec) * deg;
             star.v_mag = *row.value(mag);
             star.bv = row.value(ci);
             star.spectral_type = row.text(spect);
             if (row.value(pm_ra) && row.value(pm_dec)) {
               star.pm_ra_cosdec_rad_per_yr = *row.value(pm_ra) * mas;
               star.pm_dec_rad_per_yr = *row.value(pm_dec) * mas;
             }
             const double parsec = row.value(dist).value_or(0.0);
             if (parsec > 0 && parsec < 100000) star.parallax_rad = arcsec / parsec;
             return append_star(reading.catalogue, star);
           });
  return reading;
}

// Missing values are empty, "null" or "nan". The place of a row in its file is the star's number:
// Gaia's own have 64 bits.
StarReading parse_gaia_csv(std::string_view text, const std::string& name) {
  std::vector<std::string_view> names;
  for (const GaiaColumn& column : gaia_columns) names.emplace_back(column.name);
  StarReading reading;
  std::string why;
  for_rows(text, name, names, needed_gaia_columns, 0, reading.problems,
           [&](const Row& row, std::uint32_t count) -> const char* {
             GaiaRow star;
             for (std::size_t i = 0; i < names.size(); ++i) {
               const std::string_view field = row.text(i);
               if (field.empty() || field == "null" || field == "nan" || field == "NaN") continue;
               const auto number = row.value(i);
               if (!number) {
                 why =
                     std::string(names[i]) + ": must be a number, got '" + std::string(field) + "'";
                 return why.c_str();
               }
               star.*gaia_columns[i].value = *number;
             }
             return append_gaia_star(reading.catalogue, count, star);
           });
  return reading;
}

StarReading parse_star_csv(std::string_view text, const std::string& name) {
  enum { ra, dec, mag, id, bv, pm_ra, pm_dec, parallax, epoch };
  StarReading reading;
  std::unordered_set<std::uint32_t> ids;
  for_rows(text, name,
           {"ra_deg", "dec_deg", "mag_v", "id", "bv", "pm_ra_mas_per_yr", "pm_dec_mas_per_yr",
            "parallax_mas", "epoch_jyear"},
           3, 9, reading.problems, [&](const Row& row, std::uint32_t count) -> const char* {
             StarRecord star{.id = id_of(row, id, count)};
             if (row.value(id).value_or(star.id) != star.id)
               return "id: must be a whole number from 0 to 4294967295";
             if (ids.contains(star.id)) return "id: another star has it";
             if (row.value(pm_ra).has_value() != row.value(pm_dec).has_value())
               return "pm_ra_mas_per_yr, pm_dec_mas_per_yr: must be given together";
             star.ra_rad = *row.value(ra) * deg;
             star.dec_rad = *row.value(dec) * deg;
             star.v_mag = *row.value(mag);
             star.bv = row.value(bv);
             if (row.value(pm_ra) && row.value(pm_dec)) {
               star.pm_ra_cosdec_rad_per_yr = *row.value(pm_ra) * mas;
               star.pm_dec_rad_per_yr = *row.value(pm_dec) * mas;
             }
             if (row.value(parallax)) star.parallax_rad = *row.value(parallax) * mas;
             const double from = row.value(epoch).value_or(2000.0);
             if (!(from > 1500 && from < 2500)) return "epoch_jyear: must be in (1500, 2500)";
             const char* why = append_star(reading.catalogue, star);
             if (!why) ids.insert(star.id);
             StarCatalogue& c = reading.catalogue;
             if (!why && from != c.epoch_jyear) move_star(c, c.size() - 1, from, c.epoch_jyear);
             return why;
           });
  return reading;
}

}  // namespace dmise
