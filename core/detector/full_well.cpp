#include "core/detector/full_well.h"

#include "core/detector/detector.h"
#include "core/detector/noise/detector_kernels.h"
#include "core/effects/plan_facts.h"

namespace dmise {

ErrorBound FullWell::error(int, const PlanFacts& f) const {
  return f.brightest_pixel_e() < full_well_e ? ErrorBound{} : not_bounded;
}

double FullWell::cost_s(int level, const PlanFacts& f) { return level * 0.1e-9 * f.pixels(); }

std::span<const ParameterOf<FullWell>> FullWell::parameters() {
  static constexpr ParameterOf<FullWell> table[] = {
      {"full_well_e", "", "[e-] that a pixel holds", &FullWell::full_well_e, 0.0, 1e9, true, true}};
  return table;
}

bool FullWell::applies(const Detector& detector) const {
  return well_is_limited && !detector.blooming;  // blooming handles the excess
}

void FullWell::apply(const ExposureFacts& exposed, Piece& piece) const {
  const auto clip = kernel_of(exposed.level, sse2::clip, avx2::clip, avx512::clip);
  const auto e = piece.electrons;
  const std::size_t full = clip(float(full_well_e), e.data(), e.size());
  if (!piece.flags.empty() && full > 0)
    for (std::size_t i = 0; i < e.size(); ++i)
      if (e[i] >= float(full_well_e)) piece.flags[i] |= flag_full_well;
  piece.saturated->full_well += full;
}

}  // namespace dmise
