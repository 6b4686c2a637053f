#pragma once
#include <string>

#include "core/config/scenario.h"
#include "nodes/runtime/protocol/kept_frames.h"
#include "sensors/pipeline/frame_pipeline.h"

namespace dmise {

/// Adds a frame to those that are served: its FITS file in `directory` if there is one; else, while
/// somebody is there to ask, the same bytes in memory.
void keep_frame(const FrameProducts& frame, const OutputConfig& output,
                const std::string& directory, KeptFrames& kept);

}  // namespace dmise
