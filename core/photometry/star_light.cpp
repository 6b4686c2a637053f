#include "core/photometry/star_light.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/spectrum.h"

namespace dmise {
namespace {

constexpr double step = 0.01;
constexpr int steps = 240;  // least_bv + steps x step = greatest_bv

}  // namespace

ColourTemperature colour_temperature(double bv) {
  const double used = std::isnan(bv) ? least_bv : std::clamp(bv, least_bv, greatest_bv);
  return {4600.0 * (1.0 / (0.92 * used + 1.7) + 1.0 / (0.92 * used + 0.62)), !(used == bv)};
}

StarLight::StarLight(const Band& band) {
  check_band(band);
  const double zero_point = zero_point_photons_per_s_m2(johnson_v());
  for (int i = 0; i <= steps; ++i) {
    const double kelvin = colour_temperature(least_bv + i * step).kelvin;
    at_v_0_.push_back(zero_point * black_body_photon_rate(kelvin, band) /
                      black_body_photon_rate(kelvin, johnson_v()));
  }
}

double StarLight::photons_per_s_m2(double v_mag, double bv) const {
  const double used = bv >= least_bv ? std::min(bv, greatest_bv) : least_bv;
  const double at = (used - least_bv) / step;
  const int low = std::min(int(at), steps - 1);
  const double at_v_0 = at_v_0_[low] + (at - low) * (at_v_0_[low + 1] - at_v_0_[low]);
  return light_of_magnitude(v_mag) * at_v_0;
}

void StarLight::photons_per_s_m2(std::span<const float> v_mag, std::span<const float> bv,
                                 std::span<double> rate) const {
  if (v_mag.size() != rate.size() || bv.size() != rate.size())
    throw Error("star light: magnitudes, colours and rates differ in number");
  for (std::size_t i = 0; i < rate.size(); ++i)
    rate[i] = photons_per_s_m2(double(v_mag[i]), double(bv[i]));
}

}  // namespace dmise
