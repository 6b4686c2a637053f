#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/base/files/text_fields.h"

// Pieces that the readers of star catalogues share.
namespace dmise::star_text {

/// Columns `first`..`last` of a fixed-width line, counted from 1 as in the catalogues' own
/// descriptions, trimmed; what lies beyond the line's end is empty.
std::string_view columns(std::string_view line, std::size_t first, std::size_t last);

/// Calls `use(line, number from 1)` for every line, without its end (LF or CRLF).
template <class Use>
void for_lines(std::string_view text, Use&& use) {
  LineReader lines(text);
  while (const auto line = lines.next()) use(*line, lines.line());
}

/// Splits a CSV line (RFC 4180, no line ends inside quotes) into trimmed fields; quotes are taken
/// off and doubled quotes are left as they are.
void split_csv(std::string_view line, std::vector<std::string_view>& fields);

/// Place of each named column in a header; -1 where there is none.
std::vector<int> find_columns(const std::vector<std::string_view>& header,
                              const std::vector<std::string_view>& names);

/// Sexagesimal digits to a number: value of `whole minutes seconds`, each checked for its range
/// (minutes < 60, seconds <= 60: catalogues round 59.996 to 60.00). None when one is not a number
/// or out of range.
std::optional<double> sexagesimal(std::string_view whole, std::string_view minutes,
                                  std::string_view seconds);

}  // namespace dmise::star_text
