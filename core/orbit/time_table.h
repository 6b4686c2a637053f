#pragma once
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace dmise {

/// A row of a table over time.
struct TimeTableRow {
  const std::string& source;     // for messages
  int line = 0;                  // in the file, from 1
  std::string text;              // for messages
  std::vector<double> values{};  // the time first

  /// Throws `ConfigError` `source:line: reason, got "text"`.
  [[noreturn]] void fail(const std::string& reason) const;
};

/// Parses a CSV of numbers with this header, whose first column is an increasing time, and calls
/// `use` for each row. Lines that begin with '#' are comments. Throws `ConfigError` `source:line:
/// reason, got "value"`, also for less than two rows.
void parse_time_table(std::string_view text, const std::string& source, std::string_view header,
                      const std::function<void(const TimeTableRow&)>& use);

}  // namespace dmise
