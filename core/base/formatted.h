#pragma once
#include <cstddef>
#include <string>

namespace dmise {

/// Returns what printf would print, of any length. The compiler checks the values.
[[gnu::format(printf, 1, 2)]] std::string formatted(const char* format, ...);

/// Returns "1 sensor", "3 sensors": a number of things whose plural ends with s, or is given.
std::string counted(std::size_t number, const std::string& thing, const std::string& things = "");

/// Returns the shortest text that reads back to the same bits.
std::string shortest_text(double value);

}  // namespace dmise
