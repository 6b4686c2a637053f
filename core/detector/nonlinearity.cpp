#include "core/detector/nonlinearity.h"

#include "core/detector/detector.h"
#include "core/effects/plan_facts.h"

namespace dmise {

double Nonlinearity::cost_s(int level, const PlanFacts& f) { return level * 0.5e-9 * f.pixels(); }

std::span<const ParameterOf<Nonlinearity>> Nonlinearity::parameters() {
  static constexpr ParameterOf<Nonlinearity> table[] = {{"nonlinearity", "NONLIN",
                                                         "relative loss of signal at full well",
                                                         &Nonlinearity::nonlinearity, 0.0, 0.5}};
  return table;
}

void Nonlinearity::apply(const ExposureFacts& exposed, Piece& piece) const {
  const auto slope = float(nonlinearity / exposed.detector.full_well_e);
  for (float& e : piece.electrons) e = e * (1.0f - slope * e);
}

}  // namespace dmise
