#pragma once
#include <memory>
#include <optional>

#include "core/base/rng.h"
#include "core/sky/clouds.h"
#include "core/sky/extinction.h"
#include "core/sky/occultation.h"
#include "sensors/pipeline/view.h"

namespace dmise {

/// The air of one site in one band, as tables.
struct AirTables {
  BandExtinction extinction;
  std::optional<CloudMap> clouds;
};

/// What becomes of light on its way from above the atmosphere to the detector, for one exposure.
class Light {
 public:
  explicit Light(const View& view);

  /// Collecting area x transmission of the optics x quantum efficiency: electrons a second for one
  /// photon/s/m2 in the band [m2].
  double electrons_per_photon_m2() const { return electrons_per_photon_m2_; }
  /// Of clear air along an apparent direction (unit), (0, 1], for a star of this B-V; 1 in space or
  /// without the effect.
  double air_transmission(const Vec<Gcrs>& apparent, double bv) const;
  /// Of clouds there, [0, 1]; 1 where there are none or without the effect.
  double cloud_transmission(const Vec<Gcrs>& apparent) const;
  /// Of both, for sunlit things.
  double transmission(const Vec<Gcrs>& apparent) const;

  /// What turbulence makes of a point source's light in this frame: a factor of mean 1, log-normal
  /// with Young's deviation (held at 1), its own for every star (by its number in the catalogue)
  /// and every object; 1 in space or without the effect.
  enum class Flickering { star, object };
  double flicker(const Vec<Gcrs>& apparent, Flickering what, std::uint32_t number) const;

  /// V magnitude of a source of the Sun's colour that gives 1 e-/s without any atmosphere.
  double zero_point_mag() const;
  /// What the zenith's clear air takes from sunlight in the band.
  double extinction_mag_per_airmass() const;

 private:
  double elevation_rad(const Vec<Gcrs>& apparent) const;

  double electrons_per_photon_m2_ = 0.0;
  Vec<Gcrs> up_;
  Rotation<Enu, Gcrs> enu_from_gcrs_;
  double zero_mag_photons_per_s_m2_ = 0.0;
  std::shared_ptr<const AirTables> air_;  // null: no air
  bool with_extinction_ = false, with_clouds_ = false, with_flicker_ = false;
  RngKey flicker_key_;
  double flicker_at_zenith_ = 0.0, time_s_ = 0.0;
};

/// Extinction over wavelength [mag/airmass] at a ground sensor, as its environment tells it.
Curve extinction_over(const View& view);

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
