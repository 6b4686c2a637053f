#pragma once
#include <string>

#include "core/base/image.h"
#include "core/products/frame_header.h"
#include "sensors/observatory/commanded_exposure.h"

namespace dmise {

/// An image as its client takes it.
struct TakenImage {
  CountImage counts;  // pixels of the window
  Window window;
  FrameHeader header;  // as in the file of the whole frame
};

/// Whether the window is all of a frame of this many pixels.
bool is_whole(const Window& window, int columns, int rows);

/// Encodes an image as a FITS file. That of a whole frame is the frame's own file, without
/// compression and flags; a part or a binned one has times, place and window, and no WCS.
std::string fits_of(const TakenImage& image, bool whole);

}  // namespace dmise
