#pragma once
#include "core/effects/effects.h"
#include "core/frames/vec.h"
#include "core/photometry/band.h"

namespace dmise {

/// The lit part of the Moon's disc, where it is in the field.
struct MoonDisc {
  static constexpr EffectFacts facts{"moon_disc",
                                     "the lit part of the Moon's disc, where it is in the field",
                                     "no Moon in the field",
                                     "Lommel and Seeliger's law (Seeliger 1887), with the "
                                     "magnitude of Krisciunas & Schaefer 1991"};
  static bool applies(const SceneFacts& scene) { return scene.moon_in_field; }
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);
};

inline constexpr double moon_radius_m = 1737.4e3;  // IAU mean radius

/// Light of a sphere of the law mu0 / (mu0 + mu) at a phase angle over that at 0: 1 - sin(a/2)
/// tan(a/2) ln cot(a/4); 0 at pi. Source: Lommel 1887 and Seeliger 1887, in Hapke 2012, Theory of
/// Reflectance and Emittance Spectroscopy.
double lommel_seeliger_phase(double phase_rad);

/// From this phase angle on the Moon's magnitude is no longer `moon_v_mag`, which has no data there
/// and does not end at new Moon: the lit limb keeps its radiance.
inline constexpr double moon_crescent_from_rad = 2.7925268031909272;  // 160 deg

/// V of the disc at the Moon's mean distance: `moon_v_mag` and its surge, beyond
/// `moon_crescent_from_rad` by the lit area. Infinite at new Moon.
double moon_disc_v_mag(double phase_rad);

/// Photons/s/m2 in a band of moonlight of V magnitude `v_mag` above the air.
double moonlight_photons_per_s_m2(double v_mag, const Band& band);

/// Irradiance by the Moon over that by the Sun in V, at a place from which they are `moon_m` and
/// `sun_m` away.
double moonlight_over_sunlight(const Vec<Gcrs>& moon_m, const Vec<Gcrs>& sun_m);
/// That ratio in a band over that in V.
double moonlight_colour(const Band& band);

/// How far from the middle of a sphere's disc its light of that law lies, towards the Sun, in the
/// disc's radii: 0 at phase angle 0, 1 at pi.
double lommel_seeliger_photocentre(double phase_rad);

/// The radiance of a sphere of that law as seen from one place. All rays are taken as parallel to
/// that to its centre, as for phase angles and magnitudes.
class LitSphere {
 public:
  /// `centre_m` and `sun_m`: from the observer, as they are seen. `whole`: photons/s/m2 of the
  /// disc, if some of it is lit.
  LitSphere(const Vec<Gcrs>& centre_m, const Vec<Gcrs>& sun_m, double radius_m, double whole);
  double angular_radius_rad() const { return radius_rad_; }
  double phase_rad() const { return phase_rad_; }
  /// Photons/s/m2 of the whole disc.
  double photons_per_s_m2() const { return whole_; }
  /// Photons/s/m2/sr of its brightest place, at most.
  double max_photons_per_s_m2_sr() const { return scale_; }
  /// Photons/s/m2/sr in a direction (unit); negative beside the sphere.
  double photons_per_s_m2_sr(const Vec<Gcrs>& direction) const;

 private:
  Vec<Gcrs> centre_, to_sun_;  // unit
  double phase_rad_, radius_rad_, whole_, scale_;
};

/// The Moon's radiance in a band.
class MoonRadiance : public LitSphere {
 public:
  MoonRadiance(const Band& band, const Vec<Gcrs>& moon_m, const Vec<Gcrs>& sun_m);
};

}  // namespace dmise
