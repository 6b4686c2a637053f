#include <gtest/gtest.h>

#include <cmath>

#include "core/detector/exposure/expose.h"
#include "tests/support/detector_of.h"

// Janesick's photon transfer: variance [DN2] = mean [DN] / K + (read noise / K)^2, here with the
// 1/12 of rounding, until the well or the ADC is full.
namespace dmise {
namespace {

constexpr int side = 500;
constexpr double pixels = double(side) * side;

struct Moments {
  double mean = 0, variance = 0;
};

template <class Value>
Moments moments(std::size_t count, const Value& value) {
  double sum = 0, sum2 = 0;
  for (std::size_t i = 0; i < count; ++i) sum += value(i), sum2 += value(i) * value(i);
  const double mean = sum / double(count);
  return {mean, sum2 / double(count) - mean * mean};
}

CountImage read_out(double light_e, const Detector& d, std::uint32_t frame = 1,
                    SaturatedPixels* saturated = nullptr) {
  Threads two(2);
  CountImage counts;
  const auto s =
      expose(ExpectedElectronImage(side, side, float(light_e)), d,
             {.seed = 3, .sensor = "s", .frame = frame, .exposure_s = 1}, {}, two, counts);
  if (saturated) *saturated = s;
  return counts;
}

struct Camera {
  const char* name;
  Detector detector;
};
const Camera cameras[] = {
    {"KAF-8300, where the ADC is full before the well",
     detector_of(
         {.read_noise_e = 9.3, .full_well_e = 25500, .gain_e_per_dn = 0.35, .bias_dn = 1000})},
    {"a well that is full before the ADC",
     detector_of(
         {.read_noise_e = 10, .full_well_e = 100000, .gain_e_per_dn = 1.8, .bias_dn = 500})},
    {"12 bits", detector_of({.read_noise_e = 2,
                             .full_well_e = 20000,
                             .gain_e_per_dn = 4,
                             .bias_dn = 50,
                             .adc_bits = 12})}};

TEST(PhotonTransfer, FollowsItsLineUntilSaturationAndFallsToNothingThere) {
  for (const auto& camera : cameras) {
    const Detector& d = camera.detector;
    const double adc_e = (std::exp2(d.adc_bits) - 1 - d.bias_dn) * d.gain_e_per_dn;
    const double limit_e = std::min(adc_e, d.full_well_e);
    for (double light = 1; light < 4 * limit_e; light *= 1.6) {
      const CountImage counts = read_out(light, d);
      const Moments m = moments(counts.pixels.size(),
                                [&](std::size_t i) { return counts.pixels[i] - d.bias_dn; });
      const double k = d.gain_e_per_dn,
                   noise_e = std::sqrt(light + d.read_noise_e * d.read_noise_e);
      if (light + 6 * noise_e < limit_e) {
        const double variance = m.mean / k + std::pow(d.read_noise_e / k, 2) + 1.0 / 12;
        // Counts of whole electrons lie on a comb when K < 1; over it the mean still holds.
        EXPECT_NEAR(m.variance / variance, 1.0, 4.5 * std::sqrt(2 / pixels))
            << camera.name << light;
        EXPECT_NEAR(m.mean, light / k, 4.5 * std::sqrt(variance / pixels)) << camera.name << light;
      } else if (light - 6 * noise_e > limit_e) {
        // Read noise is all that is left, and nothing where the ADC clips.
        EXPECT_LE(m.variance, (std::pow(d.read_noise_e / k, 2) + 1.0 / 12) * 1.02)
            << camera.name << light;
      }
    }
  }
}

// The usual way out of fixed patterns: half the variance of the difference of two frames.
TEST(PhotonTransfer, OfADifferenceOfFramesKnowsNoFixedPattern) {
  Detector d = cameras[1].detector;
  d.prnu_rms = 0.01;
  const CountImage one = read_out(40000, d, 1), two = read_out(40000, d, 2);
  const double k = d.gain_e_per_dn;
  const double shot = 40000 / (k * k) + std::pow(d.read_noise_e / k, 2) + 1.0 / 12;
  const Moments alone =
      moments(one.pixels.size(), [&](std::size_t i) { return double(one.pixels[i]); });
  const Moments difference = moments(one.pixels.size(), [&](std::size_t i) {
    return double(one.pixels[i]) - double(two.pixels[i]);
  });
  EXPECT_NEAR(difference.variance / 2 / shot, 1.0, 4 * std::sqrt(2 / pixels));
  const double pattern = std::pow(0.01 * 40000 / k, 2);
  EXPECT_NEAR(alone.variance / (shot + pattern), 1.0, 4 * std::sqrt(2 / pixels));
}

TEST(PhotonTransfer, BothLimitsAreCountedApart) {
  SaturatedPixels s;
  read_out(24000, cameras[0].detector, 1, &s);  // above the ADC's 22.6 ke-, below the well
  EXPECT_EQ(s, (SaturatedPixels{.full_well = 0, .adc = side * side}));
  read_out(1e6, cameras[1].detector, 1, &s);  // above the well, below the ADC's 117 ke-
  EXPECT_EQ(s, (SaturatedPixels{.full_well = side * side, .adc = 0}));
}

TEST(ExposureLength, OfNothingIsReadNoiseAndBiasAlone) {
  Threads one(1);
  CountImage counts;
  Detector d = cameras[1].detector;
  d.dark_e_per_s = 1e6;
  d.hot_pixel_fraction = 0.1;
  d.hot_pixel_e_per_s = 1e6;
  d.cosmic_rays_per_px_s = 1e-3;
  expose(ExpectedElectronImage(300, 300), d, {1, "s", 1, 0.0}, {}, one, counts);
  const Moments m =
      moments(counts.pixels.size(), [&](std::size_t i) { return counts.pixels[i] - d.bias_dn; });
  EXPECT_NEAR(m.mean, 0, 4 * 10 / 1.8 / 300);
  EXPECT_NEAR(m.variance, std::pow(10 / 1.8, 2) + 1.0 / 12, 32 * 4 * std::sqrt(2.0) / 300);
}

}  // namespace
}  // namespace dmise
