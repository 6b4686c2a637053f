#include "core/detector/readout/em_gain.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/detector/noise/poisson.h"
#include "core/effects/plan_facts.h"

namespace dmise {
namespace {

/// Streams of one effect that are independent.
RngKey stream_of(RngKey key, std::uint32_t number) {
  key.key[0] ^= 0x9e3779b9u * number;
  return key;
}

/// A Gamma deviate of unit scale. Marsaglia & Tsang 2000, ACM TOMS 26, 363.
double gamma_deviate(const RngKey& key, std::uint32_t pixel, double shape) {
  double boost = 1.0;
  std::uint32_t draw = 0;
  if (shape < 1.0) {
    boost = std::pow(uniform_of(rng_block(key, pixel, draw++)[0]), 1.0 / shape);
    shape += 1.0;
  }
  const double d = shape - 1.0 / 3.0, c = 1.0 / std::sqrt(9.0 * d);
  for (;;) {
    const auto words = rng_block(key, pixel, draw++);
    const double x = normal_of(words[0]), root = 1.0 + c * x;
    if (root <= 0.0) continue;
    const double v = root * root * root, u = uniform_of(words[1]), xx = x * x;
    if (u < 1.0 - 0.0331 * xx * xx || std::log(u) < 0.5 * xx + d * (1.0 - v + std::log(v)))
      return boost * d * v;
  }
}

}  // namespace

double EmGain::cost_s(int level, const PlanFacts& f) { return level * 90e-9 * f.pixels(); }

std::span<const ParameterOf<EmGain>> EmGain::parameters() {
  static constexpr ParameterOf<EmGain> table[] = {
      {"em_gain", "EMGAIN", "mean gain of the multiplication register", &EmGain::em_gain, 1.0, 1e4},
      {"em_stages", "EMSTAGES", "stages of the register", &EmGain::em_stages, 16, 10000, false,
       false, "stages of a register"},
      {"clock_induced_e", "CICE", "[e-] mean clock-induced charge of a pixel",
       &EmGain::clock_induced_e, 0.0, 1e4}};
  return table;
}

std::optional<DetectorFault> EmGain::fault(const EmGain& own) {
  // Above, a stage would more than double what it holds.
  const double most = std::pow(1.9, own.em_stages);
  if (own.em_gain <= most) return std::nullopt;
  return DetectorFault{"em_gain", "must be below 1.9^em_stages", own.em_gain};
}

double EmGain::excess_noise2() const {
  if (!(em_gain > 1.0)) return 1.0;
  const double g = em_gain;
  return 2.0 * (g - 1.0) * std::pow(g, -(em_stages + 1.0) / em_stages) + 1.0 / g;
}

void EmGain::apply(const ExposureFacts& exposed, Piece& piece) const {
  const auto e = piece.electrons;
  if (clock_induced_e > 0.0)
    ConstantPoisson(float(clock_induced_e))
        .add(exposed.key, std::uint32_t(piece.first), e.data(), e.size(), exposed.level);
  if (!(em_gain > 1.0)) return;
  // Var[n + Poisson(Gamma(a n, s))] with s = (G - 1) / a is n (G - 1) (1 + s).
  const double scale =
      std::max(0.0, em_gain * em_gain * (excess_noise2() - 1.0) / (em_gain - 1.0) - 1.0);
  const double shape = scale > 0.0 ? (em_gain - 1.0) / scale : 0.0;
  const RngKey of_gamma = stream_of(exposed.key, 1), of_poisson = stream_of(exposed.key, 2);
  constexpr std::size_t part = 1024;
  std::array<float, part> more;
  for (std::size_t i = 0; i < e.size(); i += part) {
    const std::size_t n = std::min(part, e.size() - i);
    const auto first = std::uint32_t(piece.first + i);
    for (std::size_t j = 0; j < n; ++j) {
      const double in = std::max(e[i + j], 0.0f);
      more[j] = !(in > 0.0) ? 0.0f
                : scale > 0.0
                    ? float(scale * gamma_deviate(of_gamma, first + std::uint32_t(j), shape * in))
                    : float((em_gain - 1.0) * in);
      more[j] = std::min(more[j], poisson_largest_mean);
    }
    poisson(of_poisson, first, more.data(), n, more.data(), exposed.level);
    for (std::size_t j = 0; j < n; ++j)
      e[i + j] = float((double(std::max(e[i + j], 0.0f)) + more[j]) / em_gain);
  }
}

}  // namespace dmise
