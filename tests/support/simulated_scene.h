#pragma once
#include <utility>

#include "core/base/parallel.h"
#include "core/detection/frame_scene.h"
#include "core/detection/known/star_motion.h"
#include "core/detection/pixels/background.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/products/frame_header.h"

namespace dmise::simulated {

/// Counts prepared for fits, with the PSF of their header.
struct SimulatedScene {
  FrameHeader header;
  CountImage counts;
  Threads one;
  Background background{counts, detection_limits::background_cell_px, one};
  StarMotion stars{header, counts.columns, counts.rows};
  Scene scene = frame_scene(counts, background, stars, header);

  SimulatedScene(FrameHeader header_, CountImage counts_)
      : header(std::move(header_)), counts(std::move(counts_)) {}
  SimulatedScene(const SimulatedScene&) = delete;  // parts refer to each other
  SimulatedScene& operator=(const SimulatedScene&) = delete;
};

}  // namespace dmise::simulated
