#pragma once
#include <string>

namespace dmise {

/// Returns where programs of this user keep what they can make again: $XDG_CACHE_HOME/dmise or
/// ~/.cache/dmise; empty if neither variable is set. It need not exist.
std::string cache_directory();

/// Returns where programs of this user keep what they were told to fetch: $XDG_DATA_HOME/dmise or
/// ~/.local/share/dmise; empty if neither variable is set. It need not exist.
std::string data_directory();

}  // namespace dmise
