#pragma once
#include <string>

namespace dmise {

/// Whether there is a file or directory at `path`; false also where that can't be known.
bool path_exists(const std::string& path);

/// Makes a directory and those above it. Throws `Error` "PATH: can't be made: reason", or, if the
/// user gave it by an option of the command line, `ConfigError` "OPTION: PATH: ...".
void make_directories(const std::string& path, const char* option = nullptr);

/// Removes a file or an empty directory, if it is there. Throws `Error` "PATH: can't be removed:
/// reason".
void remove_file(const std::string& path);

}  // namespace dmise
