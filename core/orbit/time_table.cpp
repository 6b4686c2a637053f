#include "core/orbit/time_table.h"

#include <algorithm>

#include "core/base/error.h"
#include "core/base/files/text_fields.h"

namespace dmise {

void TimeTableRow::fail(const std::string& reason) const {
  throw ConfigError(at_line(source, line, reason + got(text)));
}

void parse_time_table(std::string_view text, const std::string& source, std::string_view header,
                      const std::function<void(const TimeTableRow&)>& use) {
  const std::size_t columns = std::size_t(std::ranges::count(header, ',')) + 1;
  LineReader lines(without_byte_order_mark(text));
  const auto fail = [&](const std::string& reason, std::string_view value) {
    throw ConfigError(at_line(source, lines.line(), reason + got(value)));
  };
  std::size_t rows = 0;
  double last = 0.0;
  bool seen_header = false;
  while (const auto next = lines.next()) {
    const std::string_view line = trimmed(*next);
    if (line.empty() || line.front() == '#') continue;
    if (!seen_header) {
      if (line != header) fail("the header must be " + std::string(header), line);
      seen_header = true;
      continue;
    }
    TimeTableRow row{source, lines.line(), std::string(line)};
    const auto fields = csv_fields(line);
    if (fields.size() != columns)
      row.fail("expected a time and " + std::to_string(columns - 1) + " numbers");
    for (const auto& field : fields) {
      const auto number = parse_real(trimmed(field));
      if (!number) fail("not a number", field);
      row.values.push_back(*number);
    }
    if (rows++ > 0 && row.values[0] <= last) fail("times must increase", fields[0]);
    last = row.values[0];
    use(row);
  }
  if (rows < 2) fail("a table needs at least two lines", "");
}

}  // namespace dmise
