#pragma once
#include "core/base/image.h"
#include "core/optics/point_spread.h"

// From an oversampled image to the detector's pixels.
namespace dmise {

/// Which of a pixel's k x k cells are summed, along one axis, and the factor of the sum.
struct ResamplingCells {
  int first = 0, count = 1;
  float scale = 1.0f;
};
ResamplingCells resampling_cells(int oversampling, PointSpread::Resampling resampling);

/// An image on other pixels of any size that cover the same field; the light of each is the
/// integral over its area of the image taken as constant within its own pixels. Exact flux; the MTF
/// is the new pixel's own times sinc(nu w), w the old pixel's width.
ExpectedElectronImage resample_area(const ExpectedElectronImage& image, int columns, int rows);

/// The same by the value at the new pixel's centre, linear between the centres around it, times the
/// ratio of areas: the paper's. Light is lost or won where the new pixels don't average over the
/// old ones, see docs/models/optics.md; beyond the outermost centres the edge's value holds.
ExpectedElectronImage resample_bilinear(const ExpectedElectronImage& image, int columns, int rows);

}  // namespace dmise
