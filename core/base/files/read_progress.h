#pragma once
#include <functional>
#include <string>

namespace dmise {

/// Called with the share done, 0..1, and the file that is being read.
using ReadProgress = std::function<void(double, const std::string&)>;

/// Shows nothing.
inline void quietly(double, const std::string&) {}

}  // namespace dmise
