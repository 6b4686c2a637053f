#include "core/detection/curve/period_evidence.h"

#include <gtest/gtest.h>

#include <cmath>

// Evidence of linear models with normal priors, against the closed form of one unknown (Bretthorst
// 1988, Bayesian Spectrum Analysis, chapter 3): ln Z = s^2 r^2 / 2 / (1 + s^2 m) - ln(1 + s^2 m) /
// 2.
namespace dmise {
namespace {

LightEquations independent(std::vector<double> weights, std::vector<double> right) {
  LightEquations out{BandedMatrix(weights.size(), weights.size()), std::move(right), {}, 0.0};
  for (std::size_t i = 0; i < weights.size(); ++i) out.matrix.at(i, i) = weights[i];
  out.even_e.assign(weights.size(), 0.0);
  return out;
}

double of_one(double weight, double right, double sigma) {
  const double grown = 1 + sigma * sigma * weight;
  return 0.5 * sigma * sigma * right * right / grown - 0.5 * std::log(grown);
}

TEST(PeriodEvidence, IsTheClosedFormOfIndependentUnknowns) {
  const LightFit fit(independent({0.5, 2.0}, {3.0, -1.0}), {0.7, 1.5}, 1.0);
  EXPECT_NEAR(fit.log_evidence(), of_one(0.5, 3.0, 0.7) + of_one(2.0, -1.0, 1.5), 1e-12);
  // Mean and variance of a normal prior times a normal likelihood.
  EXPECT_NEAR(fit.values_e()[0], 3.0 / (0.5 + 1 / 0.49), 1e-12);
  EXPECT_NEAR(fit.variance({0.0, 1.0}), 1 / (2.0 + 1 / 2.25), 1e-12);
}

// Noise of twice the standard deviation has a quarter of the weight.
TEST(PeriodEvidence, HasTheMisfitAsNoise) {
  const LightFit fit(independent({0.5}, {3.0}), {0.7}, 4.0);
  EXPECT_NEAR(fit.log_evidence(), of_one(0.125, 0.75, 0.7), 1e-12);
}

TEST(PeriodEvidence, HasAsMuchLightInAPeriodForAnySharpness) {
  for (const WavePrior& prior : all_wave_priors()) {
    double variance = 0.0;
    for (const double sigma : prior.sigmas_e(40, 60.0, 10.0)) variance += sigma * sigma / 2;
    EXPECT_NEAR(variance, std::pow(10.0 * prior.depth, 2), 1e-9);
  }
}

}  // namespace
}  // namespace dmise
