#include "core/sky/star_file.h"

#include "core/base/error.h"
#include "core/sky/star_text.h"

namespace dmise {

using namespace star_text;

std::optional<StarFormat> guess_star_format(std::string_view text) {
  if (text.starts_with("KStars Star Data")) return StarFormat::deep;
  if (text.starts_with("SIMPLE  =")) return StarFormat::fits;
  std::optional<StarFormat> format;
  std::vector<std::string_view> fields;
  bool decided = false;
  std::size_t looked = 0;
  for_lines(text.substr(0, 1 << 20), [&](std::string_view line, std::size_t) {
    if (decided || trim(line).empty() || line.front() == '#') return;
    split_csv(line, fields);
    const std::vector<int> at =
        find_columns(fields, {"ra_deg", "mag_v", "ra", "dec", "mag", "phot_g_mean_mag"});
    if (at[0] >= 0 && at[1] >= 0)
      format = StarFormat::csv;
    else if (at[2] >= 0 && at[3] >= 0 && at[5] >= 0)
      format = StarFormat::gaia;
    else if (at[2] >= 0 && at[3] >= 0 && at[4] >= 0)
      format = StarFormat::hyg;
    else if (line.size() > 50 && number(columns(line, 1, 9)) && number(columns(line, 11, 19)) &&
             (line[10] == '+' || line[10] == '-'))
      format = StarFormat::kstars;
    else if (line.size() > 106 && number(columns(line, 1, 4)) && number(columns(line, 103, 107)))
      format = StarFormat::bsc5;
    decided = format.has_value() || ++looked == 20;
  });
  return format;
}

StarReading parse_stars(std::string_view text, const std::string& name,
                        std::optional<StarFormat> format) {
  if (!format) format = guess_star_format(text);
  if (!format)
    throw ConfigError(
        name + ": not a star catalogue that is known (kstars, HYG, BSC5, Gaia, CSV with a header)");
  StarReading reading;
  switch (*format) {
    case StarFormat::kstars:
      reading = parse_kstars(text, name);
      break;
    case StarFormat::hyg:
      reading = parse_hyg(text, name);
      break;
    case StarFormat::bsc5:
      reading = parse_bsc5(text, name);
      break;
    case StarFormat::deep:
      reading = parse_deep_stars(text, name);
      break;
    case StarFormat::gaia:
      reading = parse_gaia_csv(text, name);
      break;
    case StarFormat::fits:
      reading = parse_gaia_fits(text, name);
      break;
    case StarFormat::csv:
      reading = parse_star_csv(text, name);
      break;
  }
  if (reading.catalogue.size() == 0)
    throw ConfigError(reading.problems.empty() ? name + ": holds no star"
                                               : reading.problems.front());
  return reading;
}

}  // namespace dmise
