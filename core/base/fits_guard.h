#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace dmise {

/// Checks the headers of all HDUs of a FITS file for input on which CFITSIO 4.2 crashes: bytes that
/// are not printable ASCII, a value longer than any number or a text where a number is read
/// (overflows its message), sizes of tiles and blocks that are not whole numbers > 0 (division by
/// zero). Throws `ConfigError` `name: KEYWORD: reason`. Other errors are left to CFITSIO. Returns
/// how many bytes the HDUs take that can be told from each other; when a file in memory has fewer,
/// CFITSIO reads beyond its end once all HDUs have been counted.
std::size_t require_harmless_headers(std::string_view bytes, const std::string& name);

}  // namespace dmise
