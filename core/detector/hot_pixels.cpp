#include "core/detector/hot_pixels.h"

#include <algorithm>
#include <cmath>

#include "core/detector/detector.h"
#include "core/detector/noise/poisson.h"
#include "core/effects/plan_facts.h"

namespace dmise {

double HotPixels::cost_s(int level, const PlanFacts& f) { return level * 0.55e-9 * f.pixels(); }

std::span<const ParameterOf<HotPixels>> HotPixels::parameters() {
  static constexpr ParameterOf<HotPixels> table[] = {
      {"hot_pixel_fraction", "HOTFRAC", "share of hot pixels", &HotPixels::hot_pixel_fraction, 0.0,
       1.0},
      {"hot_pixel_e_per_s", "HOTRATE", "[e-/s] mean extra dark current of hot pixels",
       &HotPixels::hot_pixel_e_per_s, 0.0, 1e9}};
  return table;
}

HotPixels::Prepared HotPixels::among(std::size_t pixels, const RngKey& fixed_key) const {
  Prepared hot;
  // The distance to the next hot pixel is geometrically distributed.
  const double step = std::log1p(-std::min(hot_pixel_fraction, 1.0 - 1e-9));
  if (!(step < 0.0)) return hot;
  double at = -1.0;
  for (std::uint32_t i = 0;; ++i) {
    at += 1.0 + std::floor(std::log(uniform_of(rng_word(fixed_key, i, 0))) / step);
    if (at >= double(pixels)) return hot;
    const double rate = -hot_pixel_e_per_s * std::log(uniform_of(rng_word(fixed_key, i, 1)));
    hot.push_back({std::uint32_t(at), float(rate)});
  }
}

void HotPixels::apply(const ExposureFacts& exposed, const Prepared& hot, Piece& piece) const {
  auto it = std::ranges::lower_bound(hot, piece.first, {}, &HotPixel::pixel);
  for (; it != hot.end() && it->pixel - piece.first < piece.electrons.size(); ++it) {
    const auto mean = float(it->dark_e_per_s * exposed.exposure.exposure_s);
    float deviate;
    poisson(exposed.key, it->pixel, &mean, 1, &deviate);
    piece.electrons[it->pixel - piece.first] += deviate;
    if (!piece.flags.empty()) piece.flags[it->pixel - piece.first] |= flag_hot;
  }
}

}  // namespace dmise
