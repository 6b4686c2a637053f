#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace dmise {

/// Returns `text` as one line that is safe to print on a terminal: control characters, line and
/// paragraph separators and marks of writing direction become escapes (\n, \x1b, \u202e), bytes
/// that are not UTF-8 become \xff. All other characters, backslashes too, are unchanged. Text
/// beyond `max_bytes` is replaced by "... (N bytes)".
std::string printable(std::string_view text, std::size_t max_bytes = 1000);

/// Whether `text` is UTF-8 (RFC 3629): without overlong forms and surrogates.
bool is_utf8(std::string_view text);

/// "a, b, c"
std::string joined(const std::vector<std::string>& names, std::string_view separator = ", ");

}  // namespace dmise
