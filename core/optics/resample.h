#pragma once
#include "core/base/image.h"
#include "core/optics/point_spread.h"

// Resampling of an oversampled image to the detector's pixels.
namespace dmise {

/// The range of a pixel's k x k cells that are summed, along one axis, and the factor of the sum.
struct ResamplingCells {
  int first = 0, count = 1;
  float scale = 1.0f;
};
ResamplingCells resampling_cells(int oversampling, PointSpread::Resampling resampling);

/// Resamples an image to pixels of any size over the same field; each is the integral over its area
/// of the image, constant within its own pixels. Flux is exact; the MTF is the new pixel's own
/// times sinc(nu w), w the old pixel's width.
ExpectedElectronImage resample_area(const ExpectedElectronImage& image, int columns, int rows);

/// Resamples by the value at the new pixel's centre, linear between the surrounding centres, times
/// the ratio of areas (the method of the paper). Does not conserve flux if the new pixels do not
/// average over the old ones, see docs/models/optics.md; constant beyond the outermost centres.
ExpectedElectronImage resample_bilinear(const ExpectedElectronImage& image, int columns, int rows);

}  // namespace dmise
