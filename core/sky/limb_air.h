#pragma once
#include <memory>

#include "core/effects/effects.h"
#include "core/photometry/band.h"
#include "core/sky/limb_line.h"

namespace dmise {

/// The blue rim of the day side, and the arc of dawn.
struct LimbAir {
  static constexpr EffectFacts facts{
      "limb_air", "sunlit air over the Earth's limb, seen from space", "a sharp limb without air",
      "single scattering; Hansen & Travis 1974, Space Sci. Rev. 16, 527"};
  static bool applies(const SceneFacts& scene) { return scene.limb_in_field; }
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);
};

/// Geometry of a line of sight that passes over the ground: the Sun at its lowest place.
struct LimbSun {
  double tangent_height_m = 0.0;
  double sun_zenith_rad = 0.0;
  /// Cosine of the Sun's azimuth from the direction of sight: 1 looks towards the Sun.
  double towards_sun = 0.0;
};

/// Sunlight in a band that clear air scatters once into lines of sight from outside the air:
/// Rayleigh's phase function, molecules and ozone on both ways, straight lines, the solid Earth's
/// shadow, a Sun without size. No light of second scattering or of ground and clouds below, which
/// by day add a tenth to one half (Oikarinen et al. 1999, JGR 104, 31261); no haze, which shines
/// below 30 km.
class LimbAirTable {
 public:
  /// Lines that stay above it see no light.
  static constexpr double top_m = 110e3;

  explicit LimbAirTable(const Band& band);
  ~LimbAirTable();
  LimbAirTable(LimbAirTable&&) noexcept;

  /// Photons/s/m2/sr over the phase function at 1 au; 0 outside of 0..`top_m`. `scattered`
  /// interpolates between nodes that are computed when first needed, from any thread; `integrated`
  /// is the integral itself.
  double scattered(const LimbSun& at) const;
  double integrated(const LimbSun& at) const;

 private:
  struct Nodes;
  std::unique_ptr<Nodes> nodes_;
};

/// 3/4 (1 + cos^2), of an angle of scattering. Source: Rayleigh 1871.
inline double rayleigh_phase(double cosine) { return 0.75 * (1.0 + cosine * cosine); }

/// The air over the limb in a band as seen from one place.
class LimbAirRadiance {
 public:
  /// `sun_m`: geocentric.
  LimbAirRadiance(const Band& band, const Vec<Gcrs>& sun_m, const OblateEarth& earth);
  /// Photons/s/m2/sr along a line in a direction (unit); 0 before the ground. From within the air
  /// about that of the air ahead.
  double photons_per_s_m2_sr(const LimbLine& line, const Vec<Gcrs>& direction) const;

 private:
  std::shared_ptr<const LimbAirTable> table_;
  Vec<Gcrs> sun_, stretched_sun_;  // unit
  double at_distance_;             // sunlight over that at 1 au
};

}  // namespace dmise
