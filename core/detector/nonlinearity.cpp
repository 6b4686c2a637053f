#include "core/detector/nonlinearity.h"

#include "core/detector/detector.h"

namespace dmise {

std::span<const DetectorParameter> Nonlinearity::parameters() {
  static constexpr DetectorParameter table[] = {{"nonlinearity", "NONLIN",
                                                 "relative loss of signal at full well",
                                                 &Nonlinearity::nonlinearity, 0.0, 0.5}};
  return table;
}

void Nonlinearity::apply(const ExposureFacts& exposed, Piece& piece) const {
  const auto slope = float(nonlinearity / exposed.detector.full_well_e);
  for (float& e : piece.electrons) e = e * (1.0f - slope * e);
}

}  // namespace dmise
