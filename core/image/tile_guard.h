#pragma once
#include <string>

#include "core/image/fits_cards.h"
#include "core/image/fits_memory.h"

namespace dmise {

/// Checks the tiles of the compressed image that `fits` is at (FITS Standard 4.0, section 10) for
/// input on which CFITSIO 4.2 reads or writes out of bounds, before it decodes them: forms that it
/// decodes without a limit, tiles larger than the image, bytes that end within a tile. Throws
/// `ConfigError` "PLACE: KEYWORD: reason, got VALUE".
void require_harmless_tiles(Fits& fits, const FitsValues& values, const std::string& place);

}  // namespace dmise
