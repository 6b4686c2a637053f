#pragma once
#include <string>
#include <string_view>

namespace dmise {

/// Looks through the headers of all HDUs of a FITS file for what CFITSIO 4.2 does not survive:
/// bytes that are not printable ASCII, a value that is no string and longer than any number (its
/// message overflows), sizes of tiles and blocks that are not > 0 (it divides by them). Throws
/// `ConfigError` `name: KEYWORD: reason`. What else is wrong is left to CFITSIO.
void require_harmless_headers(std::string_view bytes, const std::string& name);

}  // namespace dmise
