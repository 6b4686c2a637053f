#pragma once
#include <cstddef>
#include <vector>

namespace dmise {

/// Light of one source: a line from end to end, convolved with a round Gaussian. Length 0 is a
/// point. The line may bend (`sagitta_px`, of a parabola whose mean offset from the chord's middle
/// line is zero) and brighten towards one end (`slope`, relative, at +length/2).
struct Trail {
  double x_px = 0.0, y_px = 0.0;
  double flux_e = 0.0;
  double length_px = 0.0;
  double angle_rad = 0.0;  // from +x towards +y
  double slope = 0.0;
  double sagitta_px = 0.0;
};

/// Which parameters of a trail a fit may move, in the order of the result's covariance.
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

/// A pixel less its background [e-], and the variance that it has without the source [e-^2].
struct FitPixel {
  int x = 0, y = 0;
  float signal_e = 0.0f;
  float variance_e2 = 1.0f;
};

struct FitSettings {
  double sigma_px = 1.0;            // of the Gaussian, pixel included
  double model_error = 0.0;         // relative error of the model, added to the noise
  double background_sigma_e = 0.0;  // > 0: an even background is fitted too, with this prior
  int most_steps = 12;
  double settled_chi2 = 1e-4;  // a step that gains less is the last
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
  /// Within `sigmas` of what noise alone would leave.
  bool good(double sigmas) const;
};

/// Electrons of the trail in pixel (x, y). The square pixel's integral is taken as a Gaussian wider
/// by 1/12 px^2 (that is in `sigma_px`): 0.4 % at the peak for a FWHM of 1.5 px.
double trail_value(const Trail& trail, double sigma_px, double x, double y);

/// Least squares (Levenberg-Marquardt) with the noise of background and photons. `free` has one
/// mask of `TrailParameter` for each trail; at most 12 parameters in all.
TrailFit fit_trails(const std::vector<FitPixel>& pixels, std::vector<Trail> start,
                    const std::vector<unsigned>& free, const FitSettings& settings);

}  // namespace dmise
