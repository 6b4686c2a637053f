#include "core/sky/variables/gcvs_file.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstddef>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"
#include "core/base/units.h"
#include "core/sky/stars/star_text.h"

namespace dmise {
namespace {

constexpr double max_mag = 50.0, max_period_d = 1e6, max_epoch_d = 200000.0;

/// A field of a line, with the column at which it begins, from 1.
struct Field {
  std::string_view text;
  std::size_t column = 1;
};

/// What is wrong with a field.
struct Problem {
  Field field;
  std::string reason;
};

std::vector<Field> fields_of(std::string_view line) {
  std::vector<Field> fields;
  std::size_t begin = 0;
  for (std::size_t i = 0; i <= line.size(); ++i) {
    if (i < line.size() && line[i] != '|') continue;
    const std::string_view whole = line.substr(begin, i - begin);
    const std::size_t blanks = std::min(whole.find_first_not_of(' '), whole.size());
    fields.push_back({trimmed(whole), begin + (blanks < whole.size() ? blanks : 0) + 1});
    begin = i + 1;
  }
  return fields;
}

/// A number with its signs around it.
struct Marked {
  std::optional<double> value;
  bool is_limit = false;     // "<" or ">"
  bool in_brackets = false;  // "(": of magnitudes an amplitude
};

/// Reads a number after "<", ">" or "(" and before ":", ")", "*N", "/N" or a band. Throws `Problem`
/// if it is no number in `least`..`most`.
Marked marked(const Field& field, double least, double most, const char* what) {
  Marked out;
  std::string_view text = field.text;
  while (!text.empty() && (text.front() == '<' || text.front() == '>' || text.front() == '(')) {
    (text.front() == '(' ? out.in_brackets : out.is_limit) = true;
    text = trimmed(text.substr(1));
  }
  if (text.empty()) return out;
  const std::size_t end = text.find_first_not_of("0123456789.+-");
  const auto value = parse_real(text.substr(0, end));
  constexpr std::size_t longest_mark = 4;  // ":", ")", "*N", "/N", a band
  const std::string_view mark = trimmed(text.substr(std::min(end, text.size())));
  if (!value) {
    if (text == ":" || text == "-" || text == "+") return out;  // the number is not known
    throw Problem{field, std::string("must be ") + what + got(field.text)};
  }
  if (mark.size() > longest_mark)
    throw Problem{field, std::string("must be ") + what + got(field.text)};
  if (!(*value >= least && *value <= most))
    throw Problem{field, std::string("must be ") + what + got(field.text)};
  out.value = value;
  return out;
}

/// Reads "hhmmss.ss +ddmmss.s". False: there is none.
bool read_place(const Field& field, VariableRecord& star) {
  std::string_view text = field.text;
  while (!text.empty() && (text.back() == ':' || text.back() == ' ')) text.remove_suffix(1);
  if (text.empty()) return false;
  const auto no_place = [&] {
    return Problem{field, "must be a place, hhmmss.ss +ddmmss.s" + got(field.text)};
  };
  const std::size_t sign = text.find_first_of("+-");
  if (sign == std::string_view::npos) throw no_place();
  const std::string_view ra = trimmed(text.substr(0, sign)), dec = trimmed(text.substr(sign + 1));
  if (ra.size() < 4 || dec.size() < 4) throw no_place();
  const auto seconds = [](std::string_view digits) {
    return digits.size() > 4 ? digits.substr(4) : std::string_view("0");
  };
  const auto hours = star_text::sexagesimal(ra.substr(0, 2), ra.substr(2, 2), seconds(ra));
  const auto degrees = star_text::sexagesimal(dec.substr(0, 2), dec.substr(2, 2), seconds(dec));
  if (!hours || !degrees || *hours >= 24.0 || *degrees > 90.0) throw no_place();
  star.ra_rad = *hours * 15.0 * deg;
  star.dec_rad = (text[sign] == '-' ? -*degrees : *degrees) * deg;
  return true;
}

std::string name_of(std::string_view text) {
  std::string name;
  for (const char c : text) {
    if (c == '*') continue;
    if (c != ' ' || (!name.empty() && name.back() != ' ')) name += c;
  }
  while (!name.empty() && name.back() == ' ') name.pop_back();
  return name;
}

/// Depth of a minimum below the maximum; none where there is none.
std::optional<double> depth_of(const Field& field, const std::optional<double>& brightest_mag) {
  const Marked minimum = marked(field, -max_mag, max_mag, "a magnitude");
  if (!minimum.value) return std::nullopt;
  if (minimum.in_brackets) return std::max(0.0, *minimum.value);
  if (!brightest_mag) return std::nullopt;
  return std::max(0.0, *minimum.value - *brightest_mag);
}

/// One line. False: the place is not known.
bool read_star(const std::vector<Field>& f, VariableRecord& star) {
  enum : std::size_t {
    name = 1,
    place,
    type,
    maximum,
    minimum,
    second,
    band,
    epoch,
    year,
    period,
    share
  };
  star.name = name_of(f[name].text);
  star.type = std::string(f[type].text);
  star.band = std::string(f[band].text);
  const bool has_place = read_place(f[place], star);
  const Marked brightest = marked(f[maximum], -max_mag, max_mag, "a magnitude");
  if (!brightest.in_brackets) star.brightest_mag = brightest.value;
  star.depth_mag = depth_of(f[minimum], star.brightest_mag);
  star.second_depth_mag = depth_of(f[second], star.brightest_mag);
  const Marked day = marked(f[epoch], 0.0, max_epoch_d, "a Julian date less 2400000");
  if (day.value) star.epoch_hjd = 2400000.0 + *day.value;
  const Marked days = marked(f[period], 0.0, max_period_d, "a period [d]");
  if (days.value && *days.value > 0.0 && !days.is_limit) star.period_d = days.value;
  const Marked percent = marked(f[share], 0.0, 100.0, "a share of the period [%]");
  if (percent.value && *percent.value > 0.0 && *percent.value < 100.0)
    star.share_of_period = 0.01 * *percent.value;
  return has_place;
}

}  // namespace

VariableReading parse_gcvs(std::string_view text, const std::string& name) {
  constexpr std::size_t min_fields = 12;
  VariableReading reading;
  bool begun = false;
  LineReader lines(without_byte_order_mark(text));
  while (const auto line = lines.next()) {
    if (trimmed(*line).empty() || line->front() == '#') continue;
    const auto fields = fields_of(*line);
    const bool is_star =
        !fields[0].text.empty() && std::isdigit(static_cast<unsigned char>(fields[0].text.front()));
    if (!begun && !is_star) continue;  // a heading
    begun = true;
    try {
      if (!is_star) throw Problem{fields[0], "must be the number of a star" + got(fields[0].text)};
      if (fields.size() < min_fields)
        throw Problem{fields.back(), "the line has " + std::to_string(fields.size()) + " of " +
                                         std::to_string(min_fields) + " fields between bars"};
      VariableRecord star;
      if (read_star(fields, star))
        reading.stars.push_back(std::move(star));
      else
        ++reading.without_place;
    } catch (const Problem& problem) {
      reading.problems.push_back(name + ":" + std::to_string(lines.line()) + ":" +
                                 std::to_string(problem.field.column) + ": " + problem.reason);
    }
  }
  if (!reading.stars.empty()) return reading;
  throw ConfigError(!reading.problems.empty()
                        ? reading.problems.front()
                        : name +
                              ":1:1: no variable star in it; it must be the General Catalogue "
                              "of Variable Stars (gcvs5.txt, or gcvs_cat.dat)");
}

}  // namespace dmise
