#pragma once
#include <optional>
#include <span>
#include <vector>

#include "core/camera_calibration/detector/jackknife.h"
#include "core/camera_calibration/gaussian_stars.h"

namespace dmise {

/// Variances of the Gaussians at a distance from the middle of the frame, along the radius and
/// across it [px2].
struct FieldWidth {
  double radius_px = 0.0;
  MeasuredValue radial_px2, tangential_px2, mean_px2;
};

/// Width of the stars of all frames, before pixels.
struct LensWidth {
  MeasuredValue even_px2;         // equal for all stars
  std::vector<FieldWidth> field;  // by rising radius; empty of few stars
  MeasuredValue growth_px2;       // from the middle to the corner, of the mean
  MeasuredValue elongation_px2;   // in the corner: radial less tangential
};

/// Fits polynomials in the square of the radius. Deviations are by leaving out a part of the stars
/// at a time, and widened where frames differ by more than their stars. Empty if there are fewer
/// than 8 stars.
std::optional<LensWidth> measure_width(std::span<const GaussianStar> images, int columns, int rows);

/// Variance of the stars of a frame halfway from the middle to the corners, by the weights of
/// `measure_width` [px2]. Empty if there are fewer than 8 stars.
std::optional<double> usual_variance_px2(std::span<const GaussianStar> images, int columns,
                                         int rows);

}  // namespace dmise
