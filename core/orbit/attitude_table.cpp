#include "core/orbit/attitude_table.h"

#include <cmath>

#include "core/base/error.h"
#include "core/base/text_file.h"
#include "core/orbit/text_fields.h"

namespace dmise {

namespace {

constexpr std::string_view header = "time_s,w,x,y,z";
constexpr double least_length = 0.5, most_length = 2.0;  // what rounding never does

}  // namespace

TableAttitude parse_attitude_table(std::string_view text, const std::string& source) {
  TableAttitude table;
  LineReader lines(without_byte_order_mark(text));
  const auto fail = [&](const std::string& reason, std::string_view value) {
    throw ConfigError(source + ":" + std::to_string(lines.line()) + ": " + reason + got(value));
  };
  bool seen_header = false;
  while (const auto next = lines.next()) {
    const std::string_view line = trimmed(*next);
    if (line.empty() || line.front() == '#') continue;
    if (!seen_header) {
      if (line != header) fail("the header must be time_s,w,x,y,z", line);
      seen_header = true;
      continue;
    }
    const auto fields = csv_fields(line);
    if (fields.size() != 5) fail("expected a time and 4 numbers", line);
    double value[5];
    for (std::size_t i = 0; i < 5; ++i) {
      const auto number = parse_real(trimmed(fields[i]));
      if (!number) fail("not a number", fields[i]);
      value[i] = *number;
    }
    if (!table.time_s.empty() && value[0] <= table.time_s.back())
      fail("times must increase", fields[0]);
    const double length =
        std::hypot(std::hypot(value[1], value[2]), std::hypot(value[3], value[4]));
    if (!(length > least_length && length < most_length))
      fail("a quaternion of length " + std::to_string(length) + " is no attitude", line);
    table.time_s.push_back(value[0]);
    table.gcrs_from_body.push_back(
        {value[1] / length, value[2] / length, value[3] / length, value[4] / length});
  }
  if (table.time_s.size() < 2) fail("a table needs two lines", "");
  return table;
}

TableAttitude read_attitude_table(const std::string& path) {
  return parse_attitude_table(read_text_file(path), path);
}

}  // namespace dmise
