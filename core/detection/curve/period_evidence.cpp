#include "core/detection/curve/period_evidence.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

namespace dmise {
namespace {

constexpr std::array depths{0.1, 0.3, 1.0, 3.0};
constexpr std::array sharpnesses{0.1, 0.5, 1.0, 2.0, 4.0, 8.0, 16.0};

constexpr auto all_priors = [] {
  std::array<WavePrior, depths.size() * sharpnesses.size()> out{};
  std::size_t at = 0;
  for (const double depth : depths)
    for (const double harmonics : sharpnesses) out[at++] = {depth, harmonics};
  return out;
}();
constexpr std::array<WavePrior, 8> few_priors{{{0.3, 0.1},
                                               {0.3, 1.0},
                                               {0.3, 4.0},
                                               {0.3, 16.0},
                                               {1.0, 0.1},
                                               {1.0, 1.0},
                                               {1.0, 4.0},
                                               {1.0, 16.0}}};

LightFit fit_of(const LightEquations& harmonics, const WavePrior& prior, double even_e,
                double misfit) {
  const std::size_t fitted = harmonics.right.size() / 2;
  return {harmonics, prior.sigmas_e(fitted, harmonics.harmonics_shown, even_e), misfit};
}

}  // namespace

std::span<const WavePrior> all_wave_priors() { return all_priors; }
std::span<const WavePrior> few_wave_priors() { return few_priors; }

std::vector<double> WavePrior::sigmas_e(std::size_t harmonics_fitted, double harmonics_shown,
                                        double even_e) const {
  constexpr double folds = 14.0;       // by which the power of those left out has fallen
  constexpr double falls_over = 0.25;  // share of the harmonics shown
  const std::size_t kept = std::min(harmonics_fitted, std::size_t(std::ceil(folds * harmonics)));
  std::vector<double> power;
  double all = 1e-300;
  for (std::size_t h = 1; h <= kept; ++h) {
    const double left = (harmonics_shown - double(h)) / (falls_over * harmonics_shown);
    power.push_back(std::exp(-double(h) / harmonics) * std::clamp(left, 0.0, 1.0));
    all += power.back();
  }
  std::vector<double> out;
  for (const double one : power) out.insert(out.end(), 2, depth * even_e * std::sqrt(one / all));
  return out;
}

LightFit::LightFit(const LightEquations& equations, std::vector<double> sigmas_e, double misfit)
    : sigmas_e_(std::move(sigmas_e)), factor_(sigmas_e_.size(), sigmas_e_.size()) {
  std::vector<double> right;
  for (std::size_t i = 0; i < sigmas_e_.size(); ++i) {
    for (std::size_t j = 0; j <= i; ++j)
      factor_.at(i, j) = sigmas_e_[i] * sigmas_e_[j] * equations.matrix.at(i, j) / misfit;
    factor_.at(i, i) += 1.0;
    right.push_back(sigmas_e_[i] * equations.right[i] / misfit);
  }
  solved_.assign(sigmas_e_.size(), 0.0);
  log_evidence_ = -HUGE_VAL;
  if (!factor_.factorise()) return;
  solved_ = factor_.solve(right);
  log_evidence_ = 0.0;
  for (std::size_t i = 0; i < right.size(); ++i) {
    gain_ += right[i] * solved_[i];
    log_evidence_ -= std::log(factor_.at(i, i));
  }
  log_evidence_ += 0.5 * gain_;
}

std::vector<double> LightFit::values_e() const {
  std::vector<double> out;
  for (std::size_t i = 0; i < sigmas_e_.size(); ++i) out.push_back(sigmas_e_[i] * solved_[i]);
  return out;
}

double LightFit::variance(std::vector<double> by) const {
  by.resize(sigmas_e_.size());
  for (std::size_t i = 0; i < by.size(); ++i) by[i] *= sigmas_e_[i];
  const std::vector<double> spread = factor_.solve(by);
  double sum = 0.0;
  for (std::size_t i = 0; i < by.size(); ++i) sum += by[i] * spread[i];
  return sum;
}

double log_evidence(const LightEquations& harmonics, std::span<const WavePrior> priors,
                    double even_e, double misfit) {
  std::vector<double> logs;
  for (const WavePrior& prior : priors)
    logs.push_back(fit_of(harmonics, prior, even_e, misfit).log_evidence());
  const double most = *std::ranges::max_element(logs);
  if (!std::isfinite(most)) return -HUGE_VAL;
  double sum = 0.0;
  for (const double one : logs) sum += std::exp(one - most);
  return most + std::log(sum / double(logs.size()));
}

WaveFit best_fit(const LightEquations& harmonics, double even_e, double misfit) {
  WaveFit best{all_priors.front(), fit_of(harmonics, all_priors.front(), even_e, misfit)};
  for (const WavePrior& prior : std::span(all_priors).subspan(1)) {
    LightFit one = fit_of(harmonics, prior, even_e, misfit);
    if (one.log_evidence() > best.light.log_evidence()) best = {prior, std::move(one)};
  }
  return best;
}

LightFit free_fit(const LightEquations& bins, double even_e, double misfit) {
  const auto fit = [&](double depth) {
    return LightFit(bins, std::vector<double>(bins.right.size(), depth * even_e), misfit);
  };
  LightFit best = fit(depths.front());
  for (const double depth : std::span(depths).subspan(1)) {
    LightFit one = fit(depth);
    if (one.log_evidence() > best.log_evidence()) best = std::move(one);
  }
  return best;
}

}  // namespace dmise
