#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace dmise {

/// `text` as one line that a terminal shows and does not obey: control characters, line and
/// paragraph separators and marks that turn the direction of writing become escapes (\n, \x1b,
/// \u202e), bytes that are no UTF-8 become \xff. The rest stays, a backslash too. More than
/// `most_bytes` of it are cut, with "... (N bytes)".
std::string printable(std::string_view text, std::size_t most_bytes = 1000);

/// "a, b, c"
std::string joined(const std::vector<std::string>& names);

}  // namespace dmise
