#pragma once
#include "core/products/frame_header.h"
#include "sensors/frame/frame_pipeline.h"
#include "sensors/scene/view.h"

namespace dmise {

/// Returns the header of a frame's file: times, pose and place, the detector as it acts, and the
/// world coordinates of the stars that each pixel sees in mid exposure. `view`: as the sensor
/// believes it to be.
FrameHeader header_of(const View& view, const PipelineSettings& settings, double psf_fwhm_px);

}  // namespace dmise
