#pragma once
#include <array>

#include "core/effects/effects.h"

namespace dmise {

struct AirFacts;  // core/effects/plan_facts.h

/// How turbulence blurs point sources: as the air of the exposure does, or as it does on average.
struct AirTurbulence {
  enum Level { off, long_exposure, short_exposure };
  static constexpr std::array<std::string_view, 3> levels{"off", "long", "short"};
  static constexpr EffectFacts facts{
      "turbulence",
      "turbulence blurs points: by its mean, or as in a short exposure",
      "1 arcsec of width with r0 = 0.11 m; by its mean no motion and no speckle",
      "Fried 1966, J. Opt. Soc. Am. 56, 1372; screens of Kolmogorov's spectrum",
      true,
      true,
      levels};
  static bool applies(const SceneFacts& scene) { return scene.turbulent; }
  static Level level(const EffectSet& effects) { return Level(effects.level(facts)); }

  static ErrorBound error(int level, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);
};

/// Standard deviation along an axis of the mean position of a point in an exposure [px]: tilt of
/// 0.18 (D / r0)^(5/3) (lambda / D)^2, averaged over the apertures of air that the wind blows past
/// and over the screens that are drawn. Sources: Noll 1976, J. Opt. Soc. Am. 66, 207; Martin 1987,
/// PASP 99, 1360, after whom the variance falls as time^(-1/3).
double image_motion_px(const AirFacts& air);

/// Share of a point's light that turbulence scatters farther than `radius_px`: the integral of
/// Kolmogorov's spectrum, 0.086 (radius r0 / lambda)^(-5/3), with a margin for 3 seeing widths and
/// more. Source: Roddier 1981, Progress in Optics 19, 281.
double scattered_beyond(const AirFacts& air, double radius_px);

}  // namespace dmise
