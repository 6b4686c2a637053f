#pragma once
#include <functional>
#include <string>
#include <string_view>

namespace dmise {

/// Returns the content of a regular file (`open_regular_file`), decompressed if it is gzip. Throws
/// `ConfigError` "PATH: reason" if it cannot be read or exceeds `limit_bytes`.
std::string read_text_file(const std::string& path, std::size_t limit_bytes = std::size_t(1) << 30);

/// Reads a file only as far as needed: `needed` tells the number of bytes to read from those that
/// are read so far, no more than these for an end.
std::string read_file_as_needed(const std::string& path,
                                const std::function<std::size_t(std::string_view so_far)>& needed);

/// Reads standard input of any kind.
std::string read_standard_input(std::size_t limit_bytes = std::size_t(1) << 30);

}  // namespace dmise
