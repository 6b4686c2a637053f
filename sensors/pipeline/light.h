#pragma once
#include <optional>

#include "core/sky/occultation.h"
#include "sensors/pipeline/view.h"

namespace dmise {

/// What becomes of light on its way from above the atmosphere to the detector, for one exposure.
class Light {
 public:
  explicit Light(const View& view);

  /// Collecting area x transmission of the optics x quantum efficiency: electrons a second for one
  /// photon/s/m2 in the band [m2].
  double electrons_per_photon_m2() const { return electrons_per_photon_m2_; }
  /// Of the atmosphere along an apparent direction (unit), (0, 1]; 1 in space or without the
  /// effect.
  double transmission(const Vec<Gcrs>& apparent) const;
  /// V magnitude of a source of the Sun's colour that gives 1 e-/s without any atmosphere.
  double zero_point_mag() const;
  double extinction_mag_per_airmass() const { return extinction_mag_per_airmass_; }

 private:
  double electrons_per_photon_m2_ = 0.0;
  double extinction_mag_per_airmass_ = 0.0;
  Vec<Gcrs> up_;
  double zero_mag_photons_per_s_m2_ = 0.0;
};

/// What the Earth hides from a sensor at one instant: below the apparent horizon on the ground,
/// behind the ellipsoid in orbit. Nothing is hidden without the effect earth_occultation.
class Hidden {
 public:
  Hidden(const View& view, SimTime t);

  /// A star's apparent direction.
  bool direction(const Vec<Gcrs>& apparent) const;
  /// An object at `position_m` (geocentric) whose apparent direction is `apparent`.
  bool object(const Vec<Gcrs>& position_m, const Vec<Gcrs>& apparent) const;

 private:
  bool on_ = false;
  Vec<Gcrs> up_;
  std::optional<FreeSight> sight_;  // in orbit
};

}  // namespace dmise
