#pragma once
#include <sys/types.h>

#include <string>

namespace dmise {

/// Opens a regular file of a real file system for reading and returns its descriptor, which the
/// caller closes. Throws `ConfigError` "PATH: reason" for anything else: directories, FIFOs and
/// devices, which may never end, and files of /proc or /sys. Never waits for a writer.
int open_regular_file(const std::string& path);

/// Opens a file to write under a name that is the program's own: creates it, or opens the regular
/// file there. A link or FIFO in its place is removed and not followed, and so is, with O_TRUNC, a
/// file that has other names. Returns -1 and sets errno if it can't be opened, or is a device. Safe
/// between fork and exec.
int open_own_file(const char* path, int flags, mode_t mode = 0644);

/// Where a file is written that a user names by an option of the command line: the end of symbolic
/// links, which need not be there yet. Throws `ConfigError` "OPTION: reason, got PATH" for what a
/// file put in its place would destroy: FIFOs, devices, and files of /proc or /sys; and for
/// directories.
std::string file_to_write(const char* option, const std::string& path);

}  // namespace dmise
