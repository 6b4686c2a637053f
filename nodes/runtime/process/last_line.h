#pragma once
#include <string>

namespace dmise {

/// The message of the last non-empty line of a log.
std::string last_line(const std::string& path);

}  // namespace dmise
