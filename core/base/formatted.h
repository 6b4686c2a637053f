#pragma once
#include <string>

namespace dmise {

/// Returns what printf would print, of any length. The compiler checks the values.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

}  // namespace dmise
