#pragma once
#include <functional>
#include <string>

namespace dmise {

/// Is called with the share done and the file that is being read.
using ReadProgress = std::function<void(double, const std::string&)>;

/// Shows nothing.
inline void quietly(double, const std::string&) {}

}  // namespace dmise
