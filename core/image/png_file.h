#pragma once
#include <string>

#include "core/base/image.h"

namespace dmise {

/// A PNG file in memory, grey or RGB by the picture's channels (1 or 3). Equal pictures give equal
/// bytes with one version of libpng and zlib. Throws `Error`.
std::string encode_png(const Picture& picture);

/// Whole or not at all; an `Error` names the file.
void write_png(const std::string& path, const Picture& picture);

}  // namespace dmise
