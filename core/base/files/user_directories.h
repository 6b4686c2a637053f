#pragma once
#include <string>

namespace dmise {

/// Returns this user's directory for files that programs can make again: $XDG_CACHE_HOME/dmise or
/// ~/.cache/dmise; empty if neither variable is set. It need not exist.
std::string cache_directory();

/// Returns this user's directory for data that programs were told to fetch: $XDG_DATA_HOME/dmise or
/// ~/.local/share/dmise; empty if neither variable is set. It need not exist.
std::string data_directory();

/// Returns this user's directory for settings: $XDG_CONFIG_HOME/dmise or ~/.config/dmise; empty if
/// neither variable is set. It need not exist.
std::string config_directory();

}  // namespace dmise
