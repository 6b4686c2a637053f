#pragma once
#include <array>

#include "core/effects/effects.h"
#include "core/photometry/band.h"
#include "core/sky/airglow.h"
#include "core/sky/limb_line.h"

namespace dmise {

/// The layers of airglow seen from above: a ring over the Earth's limb, and a veil before its night
/// side.
struct LimbAirglow {
  static constexpr EffectFacts facts{
      "limb_airglow", "airglow over the Earth's limb and before its disc, seen from space",
      "no airglow: 17.9 mag/arcsec2 in V at its brightest",
      "van Rhijn 1921; Baker & Stair 1988, Phys. Scr. 37, 611; Mende et al. 1993, JGR 98, 19117"};
  static bool applies(const SceneFacts& scene) { return scene.limb_in_field; }
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);
};

/// Airglow in a band as a sum of shells, each of which shines at height h by (1 - x^2)^2, x = (h -
/// middle) / half width. Along any line that is a polynomial, which is integrated exactly. Seen
/// from the ground it is `Airglow` above the air, by day too and equally bright everywhere.
class AirglowShells {
 public:
  /// A shell that shines from middle - half width to middle + half width.
  struct Shell {
    double middle_m, half_width_m;
    double zenith_photons_per_s_m2_sr;  // seen from below
    double photons_per_s_m3_sr = 0.0;   // in its middle
  };
  /// Has the spectrum `airglow_spectrum`, 0.2-2.5 um; a band beyond it gets no light there.
  AirglowShells(const Airglow& airglow, const Band& band);

  /// OH; and lines of oxygen and sodium with the continuum.
  const std::array<Shell, 2>& shells() const { return shells_; }
  /// Height above which nothing shines.
  double top_m() const;
  double zenith_photons_per_s_m2_sr() const;
  /// Photons/s/m2/sr along a line to the ground or out of the shells. `behind`: share of the light
  /// from beyond the line's lowest place that arrives.
  double photons_per_s_m2_sr(const LimbLine& line, double behind = 1.0) const;

 private:
  std::array<Shell, 2> shells_;
};

}  // namespace dmise
