#pragma once
#include <span>

#include "core/base/parallel.h"
#include "core/ingest/colour_mosaic.h"
#include "core/ingest/count_map.h"
#include "core/ingest/standard_cards.h"
#include "core/products/frame_header.h"

namespace dmise {

/// What counts were made of.
struct CountSource {
  std::span<const double> values;  // NaN where there is none; of a mosaic as they were recorded
  CountMap map;
  int planes = 1;                        // that were added
  const ColourMosaic* mosaic = nullptr;  // if they were evened
};

/// Sets gain, bias, read noise and saturation of `header` in counts: from EGAIN or GAIN; BIASLVL or
/// PEDESTAL; RDNOISE, READNOIS or ENOISE; SATURATE or SATLEVEL, else from the frame itself. What
/// stays unknown is noted.
void set_detector(const StandardCards& cards, const CountSource& source, const CountImage& counts,
                  Threads& threads, FrameHeader& header);

}  // namespace dmise
