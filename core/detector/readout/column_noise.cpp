#include "core/detector/readout/column_noise.h"

#include "core/effects/plan_facts.h"

namespace dmise {

ErrorBound ColumnNoise::error(int, const PlanFacts& f) const {
  return {.noise = f.without_charge(column_noise_e * column_noise_e).noise};
}

double ColumnNoise::cost_s(int level, const PlanFacts& f) { return level * 0.85e-9 * f.pixels(); }

std::span<const ParameterOf<ColumnNoise>> ColumnNoise::parameters() {
  static constexpr ParameterOf<ColumnNoise> table[] = {{"column_noise_e", "COLNOISE",
                                                        "[e-] rms offset of a column",
                                                        &ColumnNoise::column_noise_e, 0.0, 1e6}};
  return table;
}

ColumnNoise::Prepared ColumnNoise::prepare(const ExposureFacts& exposed) const {
  Prepared offsets(static_cast<std::size_t>(exposed.light.columns));
  rng_normals(exposed.key, 0, 0, offsets);
  for (float& e : offsets) e *= float(column_noise_e);
  return offsets;
}

void ColumnNoise::apply(const ExposureFacts&, const Prepared& offsets_e, Piece& piece) const {
  std::size_t x = piece.first % offsets_e.size();
  for (float& e : piece.electrons) {
    e += offsets_e[x];
    x = x + 1 < offsets_e.size() ? x + 1 : 0;
  }
}

}  // namespace dmise
