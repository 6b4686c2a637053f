#pragma once
#include "core/base/image.h"
#include "core/detection/light/psf.h"
#include "core/detection/pixels/background.h"
#include "core/products/frame_header.h"
#include "core/products/frame_report.h"

namespace dmise {

/// Lowest count of a clipped pixel: pixels at the full well have read noise.
double lowest_clipped_dn(const FrameHeader& header);

/// The part of the report that follows from the header.
FrameReport unmeasured_report(const CountImage& counts, const FrameHeader& header);
/// The report without what depends on the sources in the frame.
FrameReport make_report(const CountImage& counts, const FrameHeader& header,
                        const Background& background, const PsfField& psf);

}  // namespace dmise
