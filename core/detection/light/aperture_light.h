#pragma once
#include <vector>

namespace dmise {

/// Light of a point source within a distance of it, diffracted by a circular aperture with a
/// central obscuration.
class ApertureLight {
 public:
  /// `obscuration`: its diameter over the aperture's, 0 to less than 1.
  explicit ApertureLight(double obscuration);

  static constexpr double max_radius = 12.0;  // wavelength / diameter

  /// Returns the share of light within `radius`, at most `max_radius`, after a narrow blur of
  /// `variance` along each axis [wavelength / diameter and its square].
  double within(double radius, double variance) const;

 private:
  std::vector<double> within_, brightness_;  // by radius
};

}  // namespace dmise
