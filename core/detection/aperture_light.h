#pragma once
#include <vector>

namespace dmise {

/// Light of a point within a distance of it, as a circular aperture with a central obscuration
/// diffracts it.
class ApertureLight {
 public:
  /// `obscuration`: its diameter over the aperture's, 0 to less than 1.
  explicit ApertureLight(double obscuration);

  static constexpr double most_radius = 12.0;  // wavelength / diameter

  /// Share within `radius`, at most `most_radius`, of light that is spread by a narrow blur of
  /// `variance` along each axis [wavelength / diameter and its square].
  double within(double radius, double variance) const;

 private:
  std::vector<double> within_, brightness_;  // by radius
};

}  // namespace dmise
