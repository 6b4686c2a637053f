#pragma once
#include <cstddef>
#include <optional>
#include <vector>

namespace dmise {

/// Light of one source: a line convolved with a round Gaussian. Length 0 is a point. The line may
/// be curved (`sagitta_px`, of a parabola with zero mean offset from the chord) and have a
/// brightness gradient (`slope`, relative, at +length/2).
struct Trail {
  double x_px = 0.0, y_px = 0.0;
  double flux_e = 0.0;
  double length_px = 0.0;
  double angle_rad = 0.0;  // from +x towards +y
  double slope = 0.0;
  double sagitta_px = 0.0;
};

/// Parameters of a trail that a fit may vary, in the order of the result's covariance.
enum TrailParameter : unsigned {
  trail_x = 1u << 0,
  trail_y = 1u << 1,
  trail_flux = 1u << 2,
  trail_length = 1u << 3,
  trail_angle = 1u << 4,
  trail_slope = 1u << 5,
  trail_sagitta = 1u << 6,
};
inline constexpr unsigned trail_place = trail_x | trail_y | trail_flux;
inline constexpr unsigned trail_line = trail_place | trail_length | trail_angle;
inline constexpr unsigned trail_bent_line = trail_line | trail_slope | trail_sagitta;

/// Background-subtracted pixel [e-], and its variance without the source [e-^2].
struct FitPixel {
  int x = 0, y = 0;
  float signal_e = 0.0f;
  float variance_e2 = 1.0f;
};

struct FitSettings {
  double sigma_px = 1.0;            // of the Gaussian, including the pixel
  double model_error = 0.0;         // relative error of the model, added to the noise
  double background_sigma_e = 0.0;  // > 0: fits a constant background with this prior
  int most_steps = 12;
  double settled_chi2 = 1e-4;  // convergence: smallest gain of a step
  // Ends as soon as the chi2 is within so many sigmas of its expectation; empty: goes on.
  std::optional<double> good_enough_sigmas;
};

struct TrailFit {
  std::vector<Trail> trails;
  double background_e = 0.0;
  double chi2 = 0.0;
  double deviance = 0.0;  // chi2 + sum of ln variance: compares models
  int degrees = 0;        // of freedom
  bool converged = false;
  int parameters = 0;              // free ones: of trail 0, trail 1, ..., background
  std::vector<double> covariance;  // parameters x parameters

  double cov(int i, int j) const { return covariance[std::size_t(i * parameters + j)]; }
  double reduced_chi2() const { return degrees > 0 ? chi2 / degrees : 0.0; }
  /// Whether the chi2 is within `sigmas` of its expectation.
  bool good(double sigmas) const;
};

/// Electrons of the trail in pixel (x, y). The pixel's integral is approximated by a Gaussian wider
/// by 1/12 px^2 (included in `sigma_px`): 0.4 % error at the peak for a FWHM of 1.5 px.
double trail_value(const Trail& trail, double sigma_px, double x, double y);

/// Least-squares fit (Levenberg-Marquardt) with the noise of background and photons. `free` has one
/// mask of `TrailParameter` per trail; at most 12 parameters in total.
TrailFit fit_trails(const std::vector<FitPixel>& pixels, std::vector<Trail> start,
                    const std::vector<unsigned>& free, const FitSettings& settings);

}  // namespace dmise
