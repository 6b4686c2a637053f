#include "core/detector/reference_pixels.h"

#include "core/detector/detector.h"
#include "core/effects/plan_facts.h"

namespace dmise {

double ReferencePixels::cost_s(int level, const PlanFacts& f) {
  return level * 0.05e-9 * f.pixels();
}

std::span<const ParameterOf<ReferencePixels>> ReferencePixels::parameters() {
  static constexpr ParameterOf<ReferencePixels> table[] = {
      {"reference_px", "REFPIX", "[px] border without light", &ReferencePixels::reference_px, 0,
       1000}};
  return table;
}

void ReferencePixels::apply(const ExposureFacts& exposed, Piece& piece) const {
  visit_border(reference_px, exposed.light.columns, exposed.light.rows, piece.first,
               piece.electrons.size(), [&](std::size_t begin, std::size_t end) {
                 for (std::size_t i = begin; i < end; ++i) {
                   piece.electrons[i] = 0.0f;
                   if (!piece.flags.empty()) piece.flags[i] |= flag_reference;
                 }
               });
}

}  // namespace dmise
