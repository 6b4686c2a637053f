#include "core/sky/surface_brightness.h"

#include <cmath>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"

namespace dmise {
namespace {

const double one_s10_mag_per_arcsec2 = 10.0 + 2.5 * std::log10(3600.0 * 3600.0);

}  // namespace

double s10_of_mag_per_arcsec2(double v_mag_per_arcsec2) {
  return light_of_magnitude(v_mag_per_arcsec2 - one_s10_mag_per_arcsec2);
}

double mag_per_arcsec2_of_s10(double s10) {
  return one_s10_mag_per_arcsec2 + magnitude_of_light(s10);
}

double s10_of_nanolambert(double nanolambert) {
  static const double per_nl =
      s10_of_mag_per_arcsec2((20.7233 + std::log(34.08)) / 0.92104);  // light of 1 nL
  // 0.92104 is 0.4 ln 10 rounded, so light goes as the nanolamberts.
  return per_nl * nanolambert;
}

double photons_per_s_m2_sr_of_s10(const Band& band, const Spectrum& spectrum) {
  const double v_photons =
      zero_point_photons_per_s_m2(johnson_v()) * light_of_magnitude(10.0) / (deg * deg);
  return v_photons * photon_rate_per_m2(spectrum, band) / photon_rate_per_m2(spectrum, johnson_v());
}

std::optional<double> zenith_brightness_named(std::string_view preset) {
  if (preset == "urban") return 18.0;
  if (preset == "suburban") return 20.0;
  if (preset == "dark") return 21.9;
  if (preset == "space") return 22.0;
  return std::nullopt;
}

}  // namespace dmise
