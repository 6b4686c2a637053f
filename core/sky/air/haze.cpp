#include "core/sky/air/haze.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/sky/air/standard_air.h"

namespace dmise {
namespace {

struct HazeTerm {
  double share, asymmetry;
};
constexpr HazeTerm haze_forward{haze_forward_share, 0.966}, haze_body{0.923, 0.638},
    haze_backward{0.021, -0.637};

double henyey_greenstein(const HazeTerm& term, double cosine) {
  const double g = term.asymmetry;
  const double over = 1.0 + g * g - 2.0 * g * cosine;
  return term.share * (1.0 - g * g) / (over * std::sqrt(over));
}

}  // namespace

double Haze::depth_at(double wavelength_m) const {
  return optical_depth * std::pow(wavelength_m / (550 * nm), -angstrom_exponent);
}

double haze_depth_of_extinction(const Curve& extinction, double pressure_hpa) {
  constexpr double at_m = 550 * nm;
  static const double depth_per_mag = -std::log(light_of_magnitude(1.0));
  return std::max(0.0, extinction.at_or_end(at_m) * depth_per_mag -
                           rayleigh_depth(at_m) * pressure_hpa / sea_level_hpa -
                           ozone_absorption(at_m) * ozone_column_atm_cm);
}

double haze_phase(double cosine) {
  return henyey_greenstein(haze_forward, cosine) + henyey_greenstein(haze_body, cosine) +
         henyey_greenstein(haze_backward, cosine);
}

double haze_moment(int l) {
  return (haze_body.share * std::pow(haze_body.asymmetry, l) +
          haze_backward.share * std::pow(haze_backward.asymmetry, l)) /
         (haze_body.share + haze_backward.share);
}

}  // namespace dmise
