#pragma once
#include <optional>
#include <span>

#include "core/base/parallel.h"
#include "core/detection/background.h"
#include "core/ingest/count_map.h"
#include "core/ingest/standard_cards.h"
#include "core/products/frame_header.h"

namespace dmise {

/// Electrons per count by the noise of the sky: the slope of variance against level over a mesh.
struct MeasuredGain {
  double e_per_dn = 0.0, sigma = 0.0;
  int cells = 0;
};

/// Empty where levels span too little: the slope must be known to 10 %. Frames whose pixels were
/// averaged or resampled have less noise than light, and so too high a gain.
std::optional<MeasuredGain> measure_gain(const CountImage& counts, const Background& background);

/// What counts were made of.
struct CountSource {
  std::span<const double> values;  // NaN where there is none
  CountMap map;
  int planes = 1;  // that were added
};

/// Sets gain, bias, read noise and saturation of `header` in counts: from EGAIN or GAIN; BIASLVL or
/// PEDESTAL; RDNOISE, READNOIS or ENOISE; SATURATE or SATLEVEL, else from the frame itself. What
/// stays unknown is noted.
void set_detector(const StandardCards& cards, const CountSource& source, const CountImage& counts,
                  Threads& threads, FrameHeader& header);

}  // namespace dmise
