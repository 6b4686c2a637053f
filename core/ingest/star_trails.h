#pragma once
#include "core/base/parallel.h"
#include "core/ingest/standard_cards.h"
#include "core/products/frame_header.h"

namespace dmise {

/// Measures the images of stars: sets the PSF's width in `header` unless PSFFWHM states it, and the
/// attitudes at start and end of the exposure by which stars trail. Those are of a mount at rest
/// (MOUNT = 'fixed') or turning with the stars ('sidereal') if the header states it; else of a
/// mount at rest if the stars' measured trails agree with the Earth's turning, of an even drift if
/// not, and 'sidereal' if stars do not trail. What was chosen is noted. Returns whether the PSF's
/// width is stated or measured.
bool set_star_images(const StandardCards& cards, const CountImage& counts, Threads& threads,
                     FrameHeader& header);

/// Sets the attitudes of a solved header in the same way, of a frame whose pointing was not known
/// before: then it can be told whether its mount was at rest.
void set_trails_of_solved(const CountImage& counts, Threads& threads, FrameHeader& solved);

}  // namespace dmise
