#include "core/detector/exposure/expected_noise.h"
#include "tests/support/detector_of.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dmise {
namespace {

// From frame to frame, the counts of a pixel spread as foretold: the sample variance of n frames
// has a relative standard deviation of sqrt(2 / (n - 1)).
TEST(ExpectedNoise, IsTheSpreadOfManyFrames) {
  const Detector d = detector_of({.dark_e_per_s = 20,
                                  .dark_reference_c = 20,
                                  .temperature_c = 10,
                                  .dark_doubling_k = 10,
                                  .read_noise_e = 8,
                                  .full_well_e = 60000,
                                  .gain_e_per_dn = 2,
                                  .bias_dn = 300,
                                  .hot_pixel_fraction = 0.05,
                                  .hot_pixel_e_per_s = 200,
                                  .column_noise_e = 6,
                                  .nonlinearity = 0.05,
                                  .reference_px = 2});
  ExpectedElectronImage light(40, 30);
  for (std::size_t i = 0; i < light.pixels.size(); ++i) light.pixels[i] = float(i) * 20.0f;
  Threads one(1);
  const int frames = 400;
  std::vector<double> sum(light.pixels.size()), sum2(sum.size());
  CountImage counts;
  Exposure exposure{.seed = 2, .sensor = "s", .exposure_s = 3};
  for (int f = 1; f <= frames; ++f) {
    exposure.frame = std::uint32_t(f);
    expose(light, d, exposure, {}, one, counts);
    for (std::size_t i = 0; i < sum.size(); ++i)
      sum[i] += 2.0 * counts.pixels[i], sum2[i] += 4.0 * counts.pixels[i] * counts.pixels[i];
  }
  const ElectronImage noise = expected_noise(light, d, exposure, {}, one);
  double ratio = 0, worst = 0;
  for (std::size_t i = 0; i < sum.size(); ++i) {
    const double variance = (sum2[i] - sum[i] * sum[i] / frames) / (frames - 1);
    const double relative = variance / (double(noise.pixels[i]) * noise.pixels[i]);
    ratio += relative / double(sum.size());
    worst = std::max(worst, std::abs(relative - 1));
  }
  // Columns share their offset, so the mean of all pixels is less certain than independent ones.
  EXPECT_NEAR(ratio, 1.0, 0.01);
  EXPECT_LT(worst, 5.5 * std::sqrt(2.0 / (frames - 1)));
}

TEST(ExpectedNoise, OfNothingIsTheRoundingOfTheAdc) {
  const Detector d =
      detector_of({.dark_e_per_s = 5, .read_noise_e = 8, .gain_e_per_dn = 2, .column_noise_e = 6});
  EffectSet off;
  for (const EffectFacts& e :
       {PhotonNoise::facts, DarkCurrent::facts, ReadNoise::facts, ColumnNoise::facts})
    off.set(e, false);
  Threads one(1);
  const auto noise =
      expected_noise(ExpectedElectronImage(3, 3, 100.0f), d, {.exposure_s = 1}, off, one);
  EXPECT_FLOAT_EQ(noise.at(1, 1), float(2 / std::sqrt(12.0)));
}

}  // namespace
}  // namespace dmise
