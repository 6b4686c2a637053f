#pragma once
#include <string>

namespace dmise {

/// Returns the content of a regular file (`open_regular_file`), decompressed if it is gzip. Throws
/// `ConfigError` "PATH: reason" if it cannot be read or exceeds `limit_bytes`.
std::string read_text_file(const std::string& path, std::size_t limit_bytes = std::size_t(1) << 30);

/// The same for standard input of any kind.
std::string read_standard_input(std::size_t limit_bytes = std::size_t(1) << 30);

}  // namespace dmise
