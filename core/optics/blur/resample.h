#pragma once
#include "core/optics/point_spread.h"

// Resampling of an oversampled image to the detector's pixels.
namespace dmise {

/// The range of a pixel's k x k cells that are summed, along one axis, and the factor of the sum.
struct ResamplingCells {
  int first = 0, count = 1;
  float scale = 1.0f;
};

inline ResamplingCells resampling_cells(int k, PointSpread::Resampling resampling) {
  if (resampling == PointSpread::Resampling::area) return {0, k, 1.0f};
  const int count = k % 2 ? 1 : 2;
  return {(k - 1) / 2, count, float(k * k) / float(count * count)};
}

}  // namespace dmise
