#pragma once
#include <string>

namespace dmise {

/// Whole content of a regular file (`open_regular_file`), gunzipped if it is gzip. Throws
/// `ConfigError` "PATH: reason" when it can't be read or grows beyond `limit_bytes`.
std::string read_text_file(const std::string& path, std::size_t limit_bytes = std::size_t(1) << 30);

/// The same of standard input, whatever that is, to its end.
std::string read_standard_input(std::size_t limit_bytes = std::size_t(1) << 30);

}  // namespace dmise
