#pragma once
#include <cstddef>
#include <optional>
#include <span>
#include <vector>

#include "core/detection/light/trail_light.h"

namespace dmise {

/// Background-subtracted pixel [e-], and its variance without the source [e-^2].
struct FitPixel {
  int x = 0, y = 0;
  float signal_e = 0.0f;
  float variance_e2 = 1.0f;
};

/// Electrons of trails in each of some pixels, the sums over all trails.
std::vector<double> light_in(std::span<const FitPixel> pixels, std::span<const Trail> trails,
                             const Psf& psf);

/// Light of one trail, with the derivatives by its place.
struct PlacedLight {
  double value = 0.0, by_x = 0.0, by_y = 0.0;
};
std::vector<PlacedLight> placed_light_in(std::span<const FitPixel> pixels, const TrailLight& light);

struct FitSettings {
  Psf psf;
  double model_error = 0.0;         // relative error of the model, added to the noise
  double background_sigma_e = 0.0;  // > 0: fits a constant background with this prior
  int max_steps = 12;
  double settled_chi2 = 1e-4;  // convergence: smallest gain of a step
  // Ends as soon as the chi2 is within so many sigmas of its expectation; empty: goes on.
  std::optional<double> good_enough_sigmas;
};

struct TrailFit {
  std::vector<Trail> trails;
  double background_e = 0.0;
  double chi2 = 0.0;
  double deviance = 0.0;  // chi2 + sum of ln variance: compares models
  int degrees = 0;        // degrees of freedom
  bool converged = false;
  int parameters = 0;              // free ones: of trail 0, trail 1, ..., background
  std::vector<double> covariance;  // parameters x parameters

  double cov(int i, int j) const { return covariance[std::size_t(i * parameters + j)]; }
  /// Adds to the covariance of two parameters.
  void add_cov(int i, int j, double value) {
    covariance[std::size_t(i * parameters + j)] += value;
    if (i != j) covariance[std::size_t(j * parameters + i)] += value;
  }
  double reduced_chi2() const { return degrees > 0 ? chi2 / degrees : 0.0; }
  /// Whether the chi2 is within `sigmas` of its expectation.
  bool good(double sigmas) const;
};

/// Least-squares fit (Levenberg-Marquardt) with the noise of background and photons. `free` has one
/// mask of `TrailParameter` per trail; at most 16 parameters in total.
TrailFit fit_trails(const std::vector<FitPixel>& pixels, std::vector<Trail> start,
                    const std::vector<unsigned>& free, const FitSettings& settings);

}  // namespace dmise
