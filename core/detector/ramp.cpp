#include "core/detector/ramp.h"

#include <algorithm>
#include <cmath>

#include "core/detector/detector.h"
#include "core/effects/plan_facts.h"

namespace dmise {
namespace {

constexpr float few_electrons = 24.0f;  // below, each has a time of its own

/// Sum of the weights of `count` electrons that come at random.
double weigh(const RngKey& key, std::uint32_t pixel, int count,
             const std::vector<double>& weights) {
  double sum = 0.0;
  for (int k = 0; k < count; k += 4) {
    const auto words = rng_block(key, pixel, std::uint32_t(k / 4));
    for (int i = 0; i < std::min(4, count - k); ++i) {
      const double at = uniform_of(words[std::size_t(i)]) * double(weights.size());
      sum += weights[std::min(weights.size() - 1, std::size_t(at))];
    }
  }
  return sum;
}

}  // namespace

double Ramp::cost_s(int level, const PlanFacts& f) { return level * 15e-9 * f.pixels(); }

std::span<const ParameterOf<Ramp>> Ramp::parameters() {
  static constexpr ParameterOf<Ramp> table[] = {
      {"ramp_reads", "RAMPREAD", "reads up the ramp; 0: none", &Ramp::ramp_reads, 0, 4096, false,
       false, "reads of an exposure"},
      {"fowler_reads", "FOWLER", "reads at either end (Fowler); 0: a line", &Ramp::fowler_reads, 0,
       2048, false, false, "reads at either end"},
      {"reset_noise_e", "RSTNOISE", "[e-] rms noise of the reset", &Ramp::reset_noise_e, 0.0, 1e6}};
  return table;
}

std::optional<DetectorFault> Ramp::fault(const Detector& d) {
  if (2 * d.fowler_reads <= d.ramp_reads) return std::nullopt;
  return DetectorFault{"fowler_reads", "must be at most half of ramp_reads",
                       double(d.fowler_reads)};
}

std::vector<double> Ramp::weights_of_reads() const {
  const int n = ramp_reads;
  std::vector<double> weights(std::size_t(std::max(n, 1)), 1.0);
  for (int k = 0; k < n && n > 1; ++k) {
    double& weight = weights[std::size_t(k)];
    if (fowler_reads > 0) {
      // Means of reads are n - fowler_reads intervals apart.
      const double scale = (n - 1.0) / (n - fowler_reads) / fowler_reads;
      weight = k < fowler_reads ? -scale : k >= n - fowler_reads ? scale : 0.0;
    } else {
      weight = (k - 0.5 * (n - 1)) * 12.0 / (double(n) * (n + 1.0));
    }
  }
  return weights;
}

std::vector<double> Ramp::weights_of_intervals() const {
  const auto reads = weights_of_reads();
  std::vector<double> weights(reads.size() - 1);
  double after = 0.0;
  for (std::size_t k = weights.size(); k-- > 0;) weights[k] = after += reads[k + 1];
  return weights;
}

double Ramp::fitted_noise_e(double read_noise_e) const {
  if (ramp_reads == 0) return read_noise_e;
  if (ramp_reads == 1) return std::hypot(read_noise_e, reset_noise_e);
  double sum = 0.0;
  for (const double weight : weights_of_reads()) sum += weight * weight;
  return read_noise_e * std::sqrt(sum);
}

double Ramp::shot_noise2() const {
  if (ramp_reads < 2) return 1.0;
  double sum = 0.0;
  for (const double weight : weights_of_intervals()) sum += weight * weight;
  return sum / (ramp_reads - 1);
}

Ramp::Prepared Ramp::prepare(const ExposureFacts& exposed) const {
  Prepared fit;
  if (ramp_reads < 2) return fit;
  fit.weights = weights_of_intervals();
  fit.variance = std::max(0.0, shot_noise2() - 1.0);
  const Detector& detector = exposed.detector;
  if (!detector.CosmicRays::applies(detector)) return fit;
  const Exposure& named = exposed.exposure;
  const RngKey key = rng_key(named.seed, named.sensor, named.frame, CosmicRays::facts.name);
  fit.jumps = detector.charges(exposed.light.columns, exposed.light.rows, named.exposure_s, key);
  return fit;
}

void Ramp::apply(const ExposureFacts& exposed, const Prepared& fit, Piece& piece) const {
  if (fit.weights.empty()) return;
  const auto first = std::uint32_t(piece.first);
  auto jump = std::ranges::lower_bound(fit.jumps, piece.first, {}, &CosmicCharge::pixel);
  for (std::size_t i = 0; i < piece.electrons.size(); ++i) {
    const std::uint32_t pixel = first + std::uint32_t(i);
    double charge = std::max(0.0f, piece.electrons[i]), signal = 0.0;
    for (; jump != fit.jumps.end() && jump->pixel == pixel; ++jump) {
      const double jumped = std::min<double>(charge, jump->electrons);
      const double at = jump->time * double(fit.weights.size());
      signal += jumped * fit.weights[std::min(fit.weights.size() - 1, std::size_t(at))];
      charge -= jumped;
    }
    if (charge < few_electrons) {
      const double whole = std::floor(charge);
      signal += weigh(exposed.key, pixel, int(whole), fit.weights) + (charge - whole);
    } else {
      const double deviate = normal_of(rng_block(exposed.key, pixel, 0)[0]);
      signal += charge + std::sqrt(charge * fit.variance) * deviate;
    }
    piece.electrons[i] = float(signal);
  }
}

}  // namespace dmise
