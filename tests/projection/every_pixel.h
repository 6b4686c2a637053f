#pragma once
#include <string>
#include <vector>

#include "core/base/pixel.h"
#include "core/frames/vec.h"
#include "core/optics/camera.h"

namespace dmise::test {

/// A camera of 5 um pixels whose columns span `field_deg`.
Optics camera_of(const Projection& projection, double field_deg, int columns, int rows);

/// Expects that every pixel that images a direction is found again, to 1e-9 of the focal length and
/// to 1e-9 rad, and that the solid angle of a pixel up to 143 deg from the boresight agrees with
/// finite differences of directions.
void expect_one_to_one_at_every_pixel(const Optics& optics);

/// Image places that OpenCV gives directions, by tests/reference/project_with_opencv.py. Empty
/// where OpenCV is not installed. `model`: fisheye or pinhole; `coefficients` in OpenCV's order.
std::vector<PixelPosition> places_by_opencv(const std::string& model,
                                            const std::vector<double>& coefficients,
                                            const std::vector<Vec<CameraFrame>>& directions);

/// Expects that directions spread over half angles up to `max_rad` fall where OpenCV puts them,
/// and that those places are seen back, to 1e-9. Skips where OpenCV is not installed.
void expect_as_opencv(const Projection& projection, const std::string& model,
                      const std::vector<double>& coefficients, double max_rad);

}  // namespace dmise::test
