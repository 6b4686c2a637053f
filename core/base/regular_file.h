#pragma once
#include <string>

namespace dmise {

/// Opens a regular file of a real file system for reading: its descriptor, which the caller closes.
/// Throws `ConfigError` "PATH: reason" for all else: a directory, a FIFO or a device, which may
/// have no end, or a file of /proc or /sys, whose content is what the kernel makes up. Never waits
/// for a writer.
int open_regular_file(const std::string& path);

}  // namespace dmise
