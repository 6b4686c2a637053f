#include "core/photometry/star_light.h"

#include <algorithm>
#include <cmath>

#include "core/base/error.h"
#include "core/base/vector_math.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/spectrum.h"

namespace dmise {
namespace {

constexpr double step = 0.01;
constexpr int steps = 240;  // least_bv + steps x step = greatest_bv

/// Spectra of stars every `step` of B-V, with their photon rates in V.
struct StarOfColour {
  StarSpectrum spectrum;
  double in_v = 0.0;
};

const std::vector<StarOfColour>& stars_by_bv() {
  static const std::vector<StarOfColour> stars = [] {
    std::vector<StarOfColour> out;
    for (int i = 0; i <= steps; ++i) {
      StarSpectrum star = star_spectrum(least_bv + i * step);
      const double in_v = photon_rate(star, johnson_v());
      out.push_back({std::move(star), in_v});
    }
    return out;
  }();
  return stars;
}

}  // namespace

StarLight::StarLight(const Band& band) {
  check_band(band);
  const double zero_point = zero_point_photons_per_s_m2(johnson_v());
  for (const StarOfColour& star : stars_by_bv())
    at_v_0_.push_back(zero_point * photon_rate(star.spectrum, band) / star.in_v);
}

double StarLight::at_v_0(double bv) const {
  const double used = bv >= least_bv ? std::min(bv, greatest_bv) : least_bv;
  const double at = (used - least_bv) / step;
  const int low = std::min(int(at), steps - 1);
  return at_v_0_[low] + (at - low) * (at_v_0_[low + 1] - at_v_0_[low]);
}

double StarLight::photons_per_s_m2(double v_mag, double bv) const {
  return light_of_magnitude(v_mag) * at_v_0(bv);
}

void StarLight::photons_per_s_m2(std::span<const double> v_mag, std::span<const double> bv,
                                 std::span<double> rate) const {
  if (v_mag.size() != rate.size() || bv.size() != rate.size())
    throw Error("star light: magnitudes, colours and rates differ in number");
  constexpr double log_per_mag = -0.4 * 2.302585092994045684;
  for (std::size_t i = 0; i < rate.size(); ++i) rate[i] = log_per_mag * v_mag[i];
  exp_of(rate, rate);
  for (std::size_t i = 0; i < rate.size(); ++i) rate[i] *= at_v_0(bv[i]);
}

}  // namespace dmise
