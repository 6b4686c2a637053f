#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

#include "core/base/pixel.h"
#include "core/detection/light/psf.h"
#include "core/detection/light/trail_shape.h"

namespace dmise {

/// Light of one source: a line convolved with a PSF. Length 0 is a point. The line may
/// be curved (`sagitta_px`, of a parabola with zero mean offset from the chord) and have a
/// brightness gradient (`slope`, relative, at +length/2).
struct Trail {
  double x_px = 0.0, y_px = 0.0;
  double flux_e = 0.0;
  double length_px = 0.0;
  double angle_rad = 0.0;  // from +x towards +y
  double slope = 0.0;
  double sagitta_px = 0.0;

  /// A place on the straight line through its middle.
  PixelPosition at(double along_px) const {
    return {x_px + along_px * std::cos(angle_rad), y_px + along_px * std::sin(angle_rad)};
  }
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

inline constexpr std::size_t trail_parameters = 7;
using TrailDerivatives = std::array<double, trail_parameters>;

/// A trail prepared for evaluation. The pixel's integral is approximated by Gaussians wider by
/// 1/12 px^2, and for those narrower than `square_below_px` by the next term of its series, too: a
/// pixel is a square, whose fourth cumulants are -1/120 px^4. At the peak 0.7 % is left at
/// that width and 0.3 % for a FWHM of 1.2 px. Derivatives are without that term, and the one by the
/// angle without the turn of an elliptical PSF against the line.
class TrailLight {
 public:
  TrailLight(const Trail& trail, const Psf& psf);

  /// Electrons in the pixel, and their derivatives by the seven parameters in the order of
  /// `TrailParameter`.
  double operator()(double x, double y, TrailDerivatives& by) const;

  const TrailShape& shape() const { return shape_; }

 private:
  TrailShape shape_;
};

/// The normal distribution that kernels look up.
const NormalTable& normal_table();
/// Its density, to 1e-10.
double normal_density(double x);
/// Replaces values by its distribution function at them, to 1e-10.
void normal_below_each(std::vector<double>& values);

/// Electrons of the trail in pixel (x, y).
double trail_value(const Trail& trail, const Psf& psf, double x, double y);

}  // namespace dmise
