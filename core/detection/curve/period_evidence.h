#pragma once
#include <span>
#include <vector>

#include "core/base/algebra/banded_matrix.h"
#include "core/detection/curve/line_equations.h"

namespace dmise {

/// What is thought of the harmonics of a light curve before it is seen: independent and normal.
struct WavePrior {
  double depth = 1.0;      // standard deviation of the light in a period, over even light
  double harmonics = 1.0;  // over which the power of harmonics falls by a factor of e

  /// Standard deviations of cosine and sine of harmonics; those that are left out are 0. They fall
  /// to 0 at `harmonics_shown`, so that the evidence is a smooth function of the frequency.
  std::vector<double> sigmas_e(std::size_t harmonics_fitted, double harmonics_shown,
                               double even_e) const;
};

/// From a pure sine to a flash of the PSF's width.
std::span<const WavePrior> all_wave_priors();
/// Some of these, to search with.
std::span<const WavePrior> few_wave_priors();

/// Varying light that is likeliest after the pixels are seen, if each unknown is normal with a
/// standard deviation.
class LightFit {
 public:
  /// `misfit`: by which squares of errors exceed those of the noise.
  LightFit(const LightEquations& equations, std::vector<double> sigmas_e, double misfit);

  /// Logarithm of the probability of the pixels over that by even light.
  double log_evidence() const { return log_evidence_; }
  /// By how much chi2 is less than with even light.
  double gain() const { return gain_; }
  std::vector<double> values_e() const;
  /// Variance of a linear function of the values.
  double variance(std::vector<double> by) const;

 private:
  std::vector<double> sigmas_e_;
  BandedMatrix factor_;
  std::vector<double> solved_;  // values over sigmas
  double log_evidence_ = 0.0, gain_ = 0.0;
};

/// Logarithm of the mean evidence of harmonics over some priors.
double log_evidence(const LightEquations& harmonics, std::span<const WavePrior> priors,
                    double even_e, double misfit);
/// The prior with the greatest evidence, and the fit by it.
struct WaveFit {
  WavePrior prior;
  LightFit light;
};
WaveFit best_fit(const LightEquations& harmonics, double even_e, double misfit);
/// The fit of light that is independent in all bins.
LightFit free_fit(const LightEquations& bins, double even_e, double misfit);

}  // namespace dmise
