#pragma once
#include <array>
#include <vector>

#include "core/photometry/band.h"

namespace dmise {

/// The Sun as an object sees it: its centre `above_rad` over the Earth's limb, whose circle has the
/// curvature `limb_curvature` (1 / its radius in the plane that touches the sphere at the Sun; 0 is
/// a straight horizon).
struct LowSun {
  double radius_rad, above_rad, limb_curvature;
};

/// Sunlight in a band that passes the Earth's limb: refracted, spread and absorbed by the air, of a
/// disc that darkens towards its limb. Rays through the International Standard Atmosphere, taken as
/// parabolas; Rayleigh scattering (Hansen & Travis 1974, Space Sci. Rev. 16, 527) and 300 DU of
/// ozone (Bird & Riordan 1986) at 22 +- 5 km; no haze and no clouds, which dim what is below 2 % of
/// the light. The disc's brightness is mu^alpha, alpha = -0.023 + 0.292 um / wavelength (Hestroffer
/// & Magnan 1998, A&A 333, 338; held at 0 beyond 12 um).
class GrazingAir {
 public:
  explicit GrazingAir(const Band& band);

  /// Share of the Sun's light that is left at `distance_m` from the centre of an Earth of
  /// `radius_m`, 0..1.
  double light(const LowSun& sun, double distance_m, double radius_m) const;
  /// Light without air: a sharp limb before a Sun that darkens towards its own.
  double light_past_sharp_limb(const LowSun& sun) const;

  /// Bending [rad] and transmission (0..1) of a ray by its lowest height, of the nearest node of
  /// the table.
  double bending_rad(double height_m) const;
  double transmission(double height_m) const;

 private:
  void divide_disc(double alpha);

  /// A place on one half of the disc, in its radii, with its share of the light.
  struct Place {
    double up, across, share;
  };
  std::vector<Place> disc_;
  /// The disc as a pile of uniform ones: radius and share.
  std::vector<std::array<double, 2>> uniform_discs_;
  std::vector<double> bending_rad_, transmission_;
};

/// Visible fraction of a uniform disc over a sharp limb, 0..1: continuous and monotone.
double visible_fraction(const LowSun& sun);

}  // namespace dmise
