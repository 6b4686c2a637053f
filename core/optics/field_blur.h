#pragma once
#include <array>
#include <string_view>
#include <vector>

#include "core/base/numeric/monotone_cubic.h"
#include "core/effects/effects.h"
#include "core/optics/field_radius.h"

namespace dmise {

struct Optics;

/// A Zernike term of the optics' wavefront, in Noll's index; rms in metres of path.
struct WavefrontTerm {
  int noll = 4;  // 4..66: piston and tilts do not blur
  double rms_m = 0.0;

  bool operator==(const WavefrontTerm&) const = default;
};

/// A Zernike term of the wavefront over the field.
struct FieldTerm {
  int noll = 4;         // 2..66: tilts displace the light from the chief ray
  MonotoneCubic rms_m;  // length of path, by the distance from the axis

  bool operator==(const FieldTerm&) const = default;
};

/// A point spread that changes with the distance from the axis, by tables of a lens's design or
/// measurement, turned with the azimuth: theta of a term is from the radius outwards. Beyond
/// its ends a table keeps its end values; on the axis itself, which has no direction, terms with
/// one are left out and a width is the mean of both. A frame has kernels at N x N places, linear
/// between.
struct FieldBlur {
  static constexpr std::array<std::string_view, 4> levels{"off", "3x3", "5x5", "9x9"};
  static constexpr std::array<int, 4> places{1, 3, 5, 9};  // along a side
  static constexpr EffectFacts facts{
      "psf_field",
      "the blur changes over the field, by a table (kernels at N x N places, linear between)",
      "every place has the blur of the centre",
      "Gaussians by radius and azimuth, or Noll's Zernike terms turned with the azimuth",
      true,
      true,
      levels,
      2};
  static bool applies(const SceneFacts& scene) { return scene.blur_varies; }
  static ErrorBound error(int level, const PlanFacts& f);
  /// A forward transform a place, and its kernels, which are kept, a hundredth.
  static double cost_s(int level, const PlanFacts& f);

  FieldRadius radius = FieldRadius::angle_deg;
  MonotoneCubic fwhm_radial_px, fwhm_tangential_px;  // Gaussians before diffraction
  std::vector<FieldTerm> wavefront;                  // aberrations of a pupil

  bool any() const { return !fwhm_radial_px.empty() || !wavefront.empty(); }
  bool operator==(const FieldBlur&) const = default;
};

/// Variances of a Gaussian [px^2], before pixel integration.
struct GaussianShape {
  double xx = 0.0, xy = 0.0, yy = 0.0;
};

/// Shape of the camera's Gaussian at a place: of the tables, or round of `psf_fwhm_px`, with
/// diffraction in quadrature.
GaussianShape gaussian_at(const Optics& optics, const FieldPlace& place, double wavelength_m);

/// The tables' wavefront at a place, terms turned with the azimuth; a term may stand there twice.
std::vector<WavefrontTerm> terms_of_field(const Optics& optics, const FieldPlace& place);

/// Image heights, 1 at the corner, at which the tables have points within the frame, with 0, 1 and
/// some between.
std::vector<double> table_heights(const Optics& optics);

/// Narrowest and widest deviation of the Gaussians over the frame [px].
struct WidthRange {
  double min_px = 0.0, max_px = 0.0;
};
WidthRange gaussian_widths(const Optics& optics, double wavelength_m);

/// Farthest that a ray of the tables' wavefront is from the chief ray [px].
double field_spot_px(const Optics& optics);

/// What kernels at n x n places, linear between, lack at most of that of a place: the share of
/// light that is elsewhere and the displacement of its centroid [px]. By the second moments of
/// Gaussians; of pupils by the rms difference of their phases, of which the light's is no more than
/// half.
struct FieldGridError {
  double misplaced = 0.0, shift_px = 0.0;
};
FieldGridError field_grid_error(const Optics& optics, double wavelength_m, int n);

/// Where the tables' wavefront puts the centroid of light, from the chief ray [px].
std::array<double, 2> centroid_of_field_px(const Optics& optics, const FieldPlace& place);

}  // namespace dmise
