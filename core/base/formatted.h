#pragma once
#include <string>

namespace dmise {

/// Returns what printf would print, of any length. The compiler checks the values.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

/// Returns the shortest text that reads back to the same bits.
std::string shortest_text(double value);

}  // namespace dmise
