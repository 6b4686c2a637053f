#pragma once
#include <string>

namespace dmise {

/// Whole content of a file, gunzipped if it is gzip. Throws `ConfigError` "PATH: reason" when it
/// can't be read or grows beyond `limit_bytes`.
std::string read_text_file(const std::string& path, std::size_t limit_bytes = std::size_t(1) << 30);

}  // namespace dmise
