#pragma once
#include <span>
#include <vector>

// Sunlight that air scatters again and again.
namespace dmise {

/// Air in plane layers between levels, from the ground up, at one wavelength. Depths are those of
/// extinction.
struct LayeredAir {
  std::vector<double> layer_depth;  // one for each layer: one less than there are levels
  // At each level: shares of the extinction that molecules and haze (without its forward peak)
  // scatter, and share of sunlight that arrives there.
  std::vector<double> molecules, haze, sunlight;
  double sun_cosine = 1.0;  // by its zenith angle; below 0 where it is down
  double ground_albedo = 0.0;
};

/// Legendre functions of order m, P_l^m(cosine) sqrt((l - m)! / (l + m)!) without the sign
/// (-1)^m, for l = m, m + 1, ..; their products over order m are sums over spherical harmonics.
void legendre_functions(int m, double cosine, std::span<double> from_l_equal_m);

/// Diffuse light in plane layers by successive orders of scattering, for each Fourier mode of the
/// azimuth from the Sun: 8 streams upwards and 8 downwards (Gauss), sources linear in depth between
/// levels. The Sun's beam is as `LayeredAir::sunlight` says, so that it may come through curved air
/// (pseudo-spherical). Scalar: polarisation, which changes the blue light of clear air by up to a
/// tenth, is left out. Source of the method: Lenoble et al. 2007, J. Quant. Spectrosc. Radiat.
/// Transfer 107, 479.
class DiffuseLight {
 public:
  static constexpr int modes = 16;

  explicit DiffuseLight(const LayeredAir& air);

  /// Light scattered twice or more, or reflected by the ground and scattered, at a level into a
  /// direction in which light travels (`cosine` > 0: upwards), for irradiance 1 of the Sun [1/sr
  /// per depth of extinction]: the factor of cos(mode x azimuth from the direction of sunlight).
  /// `functions`: `legendre_functions` of the direction.
  double source(int mode, std::size_t level, std::span<const double> functions) const;
  /// The modes that are not 0.
  int modes_used() const { return int(moments_.size()); }
  /// Light on a horizontal plane from above at the ground, without the Sun's beam, over the Sun's
  /// irradiance.
  double downward_at_ground() const { return downward_; }

 private:
  std::vector<std::vector<double>> moments_;  // by mode: levels x moments, with the phase functions
  double downward_ = 0.0;
};

}  // namespace dmise
