#pragma once
#include <optional>
#include <span>
#include <vector>

#include "core/effects/acting_effects.h"
#include "core/sky/air/air_effects.h"
#include "core/sky/bodies/limb_extinction.h"
#include "sensors/scene/view.h"

namespace dmise {

/// The way of light from above the atmosphere to the detector, for one exposure:
/// `AirEffects` in their order, those that act, then the optics.
class Throughput {
 public:
  explicit Throughput(const View& view);

  /// Collecting area x transmission of the optics x quantum efficiency: electrons a second for one
  /// photon/s/m2 in the band [m2].
  double electrons_per_photon_m2() const { return electrons_per_photon_m2_; }

  /// Factor of the air on a source's light; in space of that over the Earth's limb.
  double of_air(const SightLine& line) const;
  /// Factors of many lines; the seconds of each effect are added to `times`.
  std::vector<double> of_air(std::span<const SightLine> lines, EffectTimes& times) const;
  /// Share of the sky's light from an apparent direction (unit) that air over the Earth's limb
  /// leaves, [0, 1]; 1 on the ground.
  double of_limb(const Vec<Gcrs>& apparent) const {
    return limb_ ? limb_->of_surface(apparent) : 1.0;
  }
  /// Whether air takes light here.
  bool has_air() const { return air_ || limb_; }
  /// Multiplies factors of many stars by that of the air, to 1e-14 of it.
  void apply_air(const SightLines& lines, std::span<double> factors, EffectTimes& times) const;
  /// Share of sunlight, or of light of another colour, from an apparent direction (unit) that air
  /// and clouds leave, [0, 1].
  double of_sunlight(const Vec<Gcrs>& apparent, double bv = sun_bv) const;

  /// One of the effects of the air; null where it does not act.
  template <class Effect>
  const Effect* find() const {
    return air_ ? air_->find<Effect>() : nullptr;
  }

  /// V magnitude of a source of the Sun's colour that gives 1 e-/s without any atmosphere.
  double zero_point_mag() const;
  /// Returns the extinction of sunlight in the band by the zenith's clear air.
  double extinction_mag_per_airmass() const;

 private:
  double electrons_per_photon_m2_ = 0.0;
  double zero_mag_photons_per_s_m2_ = 0.0;
  std::optional<ActingEffects<AirEffects>> air_;  // null: in space
  std::optional<LimbExtinction> limb_;            // null: on the ground, or there is none near
};

/// Gases over a ground sensor; none where the scenario gives no water vapour or the effect is off.
std::optional<AirGases> gases_over(const View& view);

/// The air over a ground sensor by which the thermal sky glows.
AirGases warm_air_over(const View& view);

/// Extinction over wavelength [mag/airmass] at a ground sensor, by its environment; beside gases
/// that of the rest of the air, which goes on beyond the curve.
Curve extinction_over(const View& view);

}  // namespace dmise
