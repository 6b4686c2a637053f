#pragma once
#include <cstddef>
#include <string>
#include <string_view>

namespace dmise {

/// Checks the headers of all HDUs of a FITS file for input on which CFITSIO 4.2 crashes: bytes that
/// are not printable ASCII, a value longer than any number or a text where a number is read
/// (overflows its message), sizes of tiles and blocks that are not whole numbers > 0 (division by
/// zero). Throws `ConfigError` `name: KEYWORD: reason`. Other errors are left to CFITSIO. Returns
/// the number of bytes that the headers ask for, up to the first header without an end. CFITSIO
/// takes a file in memory to be that long once it has counted the HDUs, and reads beyond the end of
/// a shorter one.
std::size_t require_harmless_headers(std::string_view bytes, const std::string& name);

/// Throws `ConfigError` `name: is truncated: N of ASKED bytes` if there are fewer than `asked`.
void require_bytes(std::string_view bytes, std::size_t asked, const std::string& name);

}  // namespace dmise
