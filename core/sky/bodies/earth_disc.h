#pragma once
#include "core/effects/effects.h"
#include "core/frames/oblate_earth.h"
#include "core/photometry/band.h"

namespace dmise {

/// The lit Earth, where a camera in space has it in the field.
struct EarthDisc {
  static constexpr EffectFacts facts{"earth_disc",
                                     "the lit Earth, where a camera in space has it in the field",
                                     "a dark Earth", "a diffuse ellipsoid (Lambert)"};
  static bool applies(const SceneFacts& scene) { return scene.earth_in_field; }
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);
};

/// The Earth's Bond albedo, with clouds, seas and air (Stephens et al. 2015, Rev. Geophys. 53, 141:
/// 0.29).
inline constexpr double usual_earth_albedo = 0.3;

/// The Earth's radiance in a band as seen from one place: sunlight that an even Lambert surface
/// returns. Its night side is dark, and it has no air.
class EarthRadiance {
 public:
  /// `from_m`: of the observer, outside the ellipsoid. Geocentric, as is `sun_m`.
  EarthRadiance(const Band& band, const Vec<Gcrs>& from_m, const Vec<Gcrs>& sun_m,
                const OblateEarth& earth, double albedo);
  /// Photons/s/m2/sr under the Sun.
  double max_photons_per_s_m2_sr() const { return full_; }
  /// Photons/s/m2/sr in a direction (any length > 0); negative beside the Earth.
  double photons_per_s_m2_sr(const Vec<Gcrs>& direction) const;

 private:
  OblateEarth earth_;
  Vec<Gcrs> from_, to_sun_;  // stretched; unit
  double beyond_m2_, full_;
};

}  // namespace dmise
