#pragma once
#include <string>

namespace dmise {

/// Opens a regular file of a real file system for reading and returns its descriptor, which the
/// caller closes. Throws `ConfigError` "PATH: reason" for anything else: directories, FIFOs and
/// devices, which may never end, and files of /proc or /sys. Never waits for a writer.
int open_regular_file(const std::string& path);

}  // namespace dmise
