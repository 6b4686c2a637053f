#include "core/instrument/vibration.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

Vibration spectrum() {
  Vibration v;
  v.psd_frequency_hz = {0.1, 1.0, 10.0, 100.0};
  v.psd_rad2_per_hz = {4.0, 2.0, 0.05, 0.001};
  for (double& p : v.psd_rad2_per_hz) p *= arcsec * arcsec;
  v.sine_frequency_hz = {25.0};
  v.sine_rms_rad = {0.3 * arcsec};
  return v;
}

struct Case {
  double exposure_s, shift_arcsec, blur_arcsec;
};

// Reference: scipy's quadrature of the spectrum, tests/reference/vibration.py, which agrees with
// means and variances over exposures of a vibration that numpy makes in time.
constexpr Case cases[] = {{0.01, 3.638985, 1.033339},
                          {0.1, 2.817118, 2.524648},
                          {1.0, 1.138628, 3.607427},
                          {10.0, 0.128722, 3.780665}};

TEST(Vibration, SplitsItsPowerIntoDisplacementAndBlur) {
  const Vibration v = spectrum();
  for (const Case& c : cases) {
    EXPECT_NEAR(v.shift_rms_rad(c.exposure_s) / arcsec, c.shift_arcsec, 2e-3 * c.shift_arcsec);
    EXPECT_NEAR(v.blur_rad(c.exposure_s) / arcsec, c.blur_arcsec, 2e-3 * c.blur_arcsec);
    EXPECT_NEAR(std::hypot(v.shift_rms_rad(c.exposure_s), v.blur_rad(c.exposure_s)),
                v.shift_rms_rad(0.0), 1e-3 * v.shift_rms_rad(0.0));
  }
  EXPECT_EQ(v.blur_rad(0.0), 0.0);
}

// Over many seeds the rms of exposures is that of the spectrum; both axes have it and are
// independent; exposures at the same time are displaced by the same.
TEST(Vibration, ExposuresAreDisplacedByItsRms) {
  const Vibration v = spectrum();
  for (const Case& c : cases) {
    double xx = 0, yy = 0, xy = 0;
    constexpr int seeds = 2000;
    for (std::uint64_t seed = 1; seed <= seeds; ++seed) {
      const RngKey key = rng_key(seed, "a", 0, "vibration");
      const ImageAxes shift = v.shift_rad(key, sim_seconds(12.5), c.exposure_s);
      xx += shift[0] * shift[0];
      yy += shift[1] * shift[1];
      xy += shift[0] * shift[1];
      EXPECT_EQ(shift[2], 0.0);
      if (seed == 1) {
        EXPECT_EQ(shift, v.shift_rad(key, sim_seconds(12.5), c.exposure_s));
      }
    }
    const double rms = c.shift_arcsec * arcsec;
    EXPECT_NEAR(std::sqrt(xx / seeds), rms, 4 * rms / std::sqrt(2.0 * seeds));
    EXPECT_NEAR(std::sqrt(yy / seeds), rms, 4 * rms / std::sqrt(2.0 * seeds));
    EXPECT_NEAR(xy / seeds, 0.0, 4 * rms * rms / std::sqrt(seeds));
  }
}

// Displacements follow one vibration: near exposures are displaced alike, far ones are not.
TEST(Vibration, NearExposuresAreDisplacedAlike) {
  Vibration v;
  v.psd_frequency_hz = {0.01, 0.1};
  v.psd_rad2_per_hz = {1.0, 1.0};
  double near = 0, far = 0, power = 0;
  for (std::uint64_t seed = 1; seed <= 500; ++seed) {
    const RngKey key = rng_key(seed, "a", 0, "vibration");
    const double first = v.shift_rad(key, sim_seconds(100.0), 0.5)[0];
    near += first * v.shift_rad(key, sim_seconds(100.6), 0.5)[0];
    far += first * v.shift_rad(key, sim_seconds(1000.0), 0.5)[0];
    power += first * first;
  }
  EXPECT_GT(near / power, 0.95);
  EXPECT_LT(std::abs(far / power), 0.2);
}

TEST(Vibration, OfNothingIsNone) {
  EXPECT_FALSE(Vibration().applies());
  Vibration v = spectrum();
  EXPECT_TRUE(v.applies());
  v.sine_rms_rad = {0.0};
  v.psd_rad2_per_hz = {0, 0, 0, 0};
  EXPECT_FALSE(v.applies());
  EXPECT_EQ(v.shift_rad(rng_key(1, "a", 0, "vibration"), sim_seconds(1), 1.0), ImageAxes{});
}

TEST(Vibration, ListsThatDoNotGoTogetherAreNamed) {
  EXPECT_EQ(spectrum().fault(), "");
  Vibration v = spectrum();
  v.psd_frequency_hz = {0.1, 1.0, 0.5, 100.0};
  EXPECT_EQ(v.fault(), "psd_hz must rise");
}

}  // namespace
}  // namespace dmise
