#include "core/photometry/star_light.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/spectrum.h"

namespace dmise {
namespace {

TEST(StarLight, ColoursOutsideTheFormulaAreClamped) {
  for (const double bv : {-0.674, -5.0, -0.41, 2.01, 5.46, double(NAN), double(INFINITY)}) {
    EXPECT_GT(colour_temperature_k(bv), 3000) << bv;
    EXPECT_LT(colour_temperature_k(bv), 22000) << bv;
    EXPECT_TRUE(std::isfinite(StarLight(Band{}).photons_per_s_m2(3.0, bv))) << bv;
  }
}

TEST(StarLight, AStarHasItsVMagnitudeInV) {
  const StarLight light(johnson_v());
  EXPECT_NEAR(light.photons_per_s_m2(0.0, 0.0), 8.75e9, 0.01 * 8.75e9);
  EXPECT_NEAR(light.photons_per_s_m2(5.0, 1.5), 8.75e7, 0.01 * 8.75e7);
}

TEST(StarLight, ManyStarsHaveTheLightOfEach) {
  const StarLight light(*filter_named("bessell-B"));
  std::vector<double> v_mag, bv;
  for (double v = -1.5; v < 20; v += 0.173) v_mag.push_back(v), bv.push_back(0.21 * v - 0.7);
  std::vector<double> rate(v_mag.size());
  light.photons_per_s_m2(v_mag, bv, rate);
  for (std::size_t i = 0; i < rate.size(); ++i) {
    const double one = light.photons_per_s_m2(v_mag[i], bv[i]);
    EXPECT_NEAR(rate[i], one, 1e-14 * one);
  }
}

TEST(StarLight, TheTableIsTheIntegralTo1e4) {
  const Band band = *filter_named("sdss-z");
  const StarLight light(band);
  for (double bv = -0.4; bv <= 2.0; bv += 0.0137) {
    const StarSpectrum star = star_spectrum(bv);
    const double rate = zero_point_photons_per_s_m2(johnson_v()) * photon_rate(star, band) /
                        photon_rate(star, johnson_v());
    EXPECT_NEAR(light.photons_per_s_m2(0.0, bv), rate, 1e-4 * rate) << bv;
  }
  for (int kind = 0; kind <= int(StarKind::m5_dwarf); ++kind)
    for (const double bv : {-0.4, 0.3, 0.95, 0.957, 1.433, 1.9999, 2.0, 9.0}) {
      const StarColour colour{bv, StarKind(kind)};
      const StarSpectrum star = star_spectrum(colour);
      const double rate = zero_point_photons_per_s_m2(johnson_v()) * photon_rate(star, band) /
                          photon_rate(star, johnson_v());
      EXPECT_NEAR(light.photons_per_s_m2(0.0, colour), rate, 3e-4 * rate) << kind << ' ' << bv;
      EXPECT_LE(rate, light.max_photons_per_s_m2(0.0) * (1.0 + 3e-4)) << kind << ' ' << bv;
    }
}

}  // namespace
}  // namespace dmise
