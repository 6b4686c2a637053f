#include "core/sky/stars/star_file.h"

#include "core/base/error.h"
#include "core/sky/stars/star_text.h"

namespace dmise {

using namespace star_text;

namespace {

using Reader = StarReading (*)(std::string_view text, const std::string& name);

/// Returns the reader of a catalogue by its first lines; null if no format looks like them.
Reader reader_of(std::string_view text) {
  if (text.starts_with("KStars Star Data")) return parse_deep_stars;
  if (text.starts_with("SIMPLE  =")) return parse_gaia_fits;
  std::vector<std::string_view> fields;
  LineReader lines(text.substr(0, 1 << 20));
  for (int looked = 0; looked < 20;) {
    const auto next = lines.next();
    if (!next) break;
    const std::string_view line = *next;
    if (trimmed(line).empty() || line.front() == '#') continue;
    ++looked;
    split_csv(line, fields);
    const std::vector<int> at =
        find_columns(fields, {"ra_deg", "mag_v", "ra", "dec", "mag", "phot_g_mean_mag"});
    if (at[0] >= 0 && at[1] >= 0) return parse_star_csv;
    if (at[2] >= 0 && at[3] >= 0 && at[5] >= 0) return parse_gaia_csv;
    if (at[2] >= 0 && at[3] >= 0 && at[4] >= 0) return parse_hyg;
    if (line.size() > 50 && parse_real(columns(line, 1, 9)) && parse_real(columns(line, 11, 19)) &&
        (line[10] == '+' || line[10] == '-'))
      return parse_kstars;
    if (line.size() > 106 && parse_real(columns(line, 1, 4)) &&
        (line[83] == '+' || line[83] == '-') && parse_real(columns(line, 103, 107)))
      return parse_bsc5;
  }
  return nullptr;
}

}  // namespace

StarReading parse_stars(std::string_view text, const std::string& name) {
  const Reader read = reader_of(text);
  if (!read)
    throw ConfigError(
        name + ": not a star catalogue that is known (kstars, HYG, BSC5, Gaia, CSV with a header)");
  StarReading reading = read(text, name);
  if (reading.catalogue.size() == 0)
    throw ConfigError(reading.problems.empty() ? name + ": holds no star"
                                               : reading.problems.front());
  return reading;
}

}  // namespace dmise
