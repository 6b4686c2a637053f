#pragma once
#include <vector>

#include "core/image/fits_file.h"
#include "core/ingest/standard_cards.h"

// Pixels of another camera whose counts are not of the sky. Their values become NaN, and are then
// not used.
namespace dmise {

/// Those outside TRIMSEC or DATASEC, or in BIASSEC if there is neither (overscan), if the section
/// is in the frame and leaves half of it or more; one that is not may be that of the frame before
/// it was cut.
void leave_out_overscan(const StandardCards& cards, int columns, int rows,
                        std::vector<double>& values);

/// Columns and rows along the edges whose median stands out from what those farther inside lead to,
/// as by an amplifier's glow or overscan that no keyword names.
void leave_out_bright_edges(const StandardCards& cards, int columns, int rows,
                            std::vector<double>& values);

/// Pixels that are brighter against their neighbours than any light through the optics: hot ones of
/// a frame without a dark, and cosmic rays. `sigma_px` of the PSF with the pixel; does nothing
/// below 0.7 px, where stars are as sharp. Marks them in `frame` and puts sky there.
void leave_out_hot_pixels(double sigma_px, Frame& frame, Threads& threads);

/// Pixels into which charge flowed along columns or rows from stars that are clipped.
void leave_out_bleeding(Frame& frame, Threads& threads);

}  // namespace dmise
