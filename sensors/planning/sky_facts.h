#pragma once
#include <algorithm>
#include <cmath>

#include "core/effects/plan_facts.h"
#include "core/optics/projection.h"
#include "core/sky/faint_starlight.h"
#include "sensors/scene/view.h"

namespace dmise {

/// Calls `visit(pixel, direction)` for pixels over a field that have one: five along each side,
/// from the first to the last but `margin_px`.
template <class Visit>
void look_over(const Optics& optics, double margin_px, Visit&& visit) {
  constexpr int looks = 5;
  for (int i = 0; i < looks; ++i)
    for (int j = 0; j < looks; ++j) {
      const PixelPosition at{i * (optics.columns - 1.0 - margin_px) / (looks - 1),
                             j * (optics.rows - 1.0 - margin_px) / (looks - 1)};
      if (const auto direction = unproject(optics, at)) visit(at, *direction);
    }
}

/// How much brighter a source may be than without scintillation: three deviations of a log-normal
/// factor of mean 1, exp(3 s - s^2 / 2), which is largest at s = 3. The sky's facts must be there.
inline double most_by_scintillation(const PlanFacts& facts) {
  const double s = std::min(facts.scintillation, 3.0);
  return std::exp(s * (3.0 - 0.5 * s));
}

/// Sets what is known of the sky, the air and the horizon in an exposure. `drawn`: stars that
/// are drawn one by one.
void add_sky_facts(const View& view, const DrawnStars& drawn, PlanFacts& facts);

}  // namespace dmise
