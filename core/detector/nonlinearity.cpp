#include "core/detector/nonlinearity.h"

namespace dmise {

void nonlinearity(double loss, double full_well_e, std::span<float> electrons) {
  const auto slope = float(loss / full_well_e);
  for (float& e : electrons) e = e * (1.0f - slope * e);
}

}  // namespace dmise
