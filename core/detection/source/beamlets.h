#pragma once
#include <vector>

#include "core/base/numeric/simd_level.h"
#include "core/base/parallel.h"
#include "core/detection/pixels/filtered_frame.h"
#include "core/detection/pixels/turned_frame.h"

namespace dmise {

/// A piece of a straight line, from the centre of a pixel to that of another, and the SNR of the
/// light along it.
struct Beamlet {
  float snr = 0.0f;
  float x1 = 0.0f, y1 = 0.0f, x2 = 0.0f, y2 = 0.0f;
};

/// Sums a frame, which is also given turned, along lines of all directions and offsets whose
/// lengths are 8, 16, .. 1024 px (at most the frame) by rows or columns, in two sets of strips that
/// are a third or two thirds of a length apart, and returns those of at least `min_snr`, one for
/// each small range of place and direction of each set, by falling SNR. Equal for any number of
/// threads. Approximate discrete Radon transform (Brady 1998, SIAM J. Comput. 27, 107; beamlets:
/// Donoho & Huo 2002): N^2 log N additions, and memory for 1024 rows a thread.
std::vector<Beamlet> find_beamlets(const FilteredFrame& frame, const TurnedFrame& turned,
                                   double min_snr, SimdLevel level, Threads& threads);

}  // namespace dmise
