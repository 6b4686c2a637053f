#include "core/detector/readout/fixed_pattern.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/detector/exposure/expected_noise.h"
#include "core/detector/exposure/expected_signal.h"
#include "core/detector/exposure/expose.h"
#include "tests/support/detector_of.h"

// What pixels and columns of a CMOS detector have of their own.
namespace dmise {
namespace {

constexpr int columns = 500, rows = 400;
constexpr double pixels = double(columns) * rows;

Exposure exposure(std::uint32_t frame = 1, const std::string& sensor = "s") {
  return {.seed = 3, .sensor = sensor, .frame = frame, .exposure_s = 1.0};
}

CountImage exposed(const Detector& d, float light_e, const Exposure& e, int thread_count = 1) {
  CountImage counts;
  Threads threads(thread_count);
  EffectSet effects;
  effects.set(PhotonNoise::facts, false);
  expose(ExpectedElectronImage(columns, rows, light_e), d, e, effects, threads, counts);
  return counts;
}

Detector with_spread(double spread) {
  Detector d = detector_of({.read_noise_e = 1.5, .gain_e_per_dn = 0.01, .bias_dn = 2000});
  d.read_noise_spread = spread;
  return d;
}

// A log-normal distribution over the pixels: Kolmogorov's distance against its distribution
// function, at a significance of 1e-3 (scipy.stats.kstwobign.ppf(0.999) = 1.9495).
TEST(ReadNoiseSpread, PixelsAreLogNormal) {
  const Detector d = with_spread(0.5);
  std::vector<float> rms_e(static_cast<std::size_t>(pixels));
  d.rms_of_pixels(rng_key(3, "s", 0, ReadNoise::facts.name), 0, rms_e);
  double squares = 0.0;
  for (const double e : rms_e) squares += e * e;
  EXPECT_NEAR(std::sqrt(squares / pixels), 1.5, 0.01);  // that of all of them is the parameter
  std::sort(rms_e.begin(), rms_e.end());
  const double median_e = 1.5 * std::exp(-0.25);
  EXPECT_NEAR(rms_e[rms_e.size() / 2], median_e, 0.01);
  double distance = 0.0;
  for (std::size_t i = 0; i < rms_e.size(); ++i) {
    const double below = 0.5 * std::erfc(-std::log(rms_e[i] / median_e) / 0.5 / std::sqrt(2.0));
    distance = std::max(distance, std::abs(below - (double(i) + 0.5) / pixels));
  }
  EXPECT_LT(distance, 1.9495 / std::sqrt(pixels));
}

// 64 frames: each pixel's deviation over its own rms is chi-square, and the noise plane has it.
TEST(ReadNoiseSpread, IsTheSameInEveryFrameOfTheSensor) {
  const Detector d = with_spread(0.5);
  constexpr int frames = 64;
  std::vector<double> squares(static_cast<std::size_t>(pixels));
  for (int k = 1; k <= frames; ++k) {
    const CountImage counts = exposed(d, 0.0f, exposure(std::uint32_t(k)));
    for (std::size_t i = 0; i < squares.size(); ++i)
      squares[i] += std::pow(0.01 * (counts.pixels[i] - 2000.0), 2);
  }
  Threads one(1);
  const auto noise = expected_noise(ExpectedElectronImage(columns, rows), d, exposure(), {}, one);
  double sum = 0.0, sum2 = 0.0;
  for (std::size_t i = 0; i < squares.size(); ++i) {
    const double chi2 = squares[i] / std::pow(noise.pixels[i], 2);
    sum += chi2;
    sum2 += chi2 * chi2;
  }
  const double mean = sum / pixels, variance = sum2 / pixels - mean * mean;
  EXPECT_NEAR(mean, frames, 4 * std::sqrt(2.0 * frames / pixels));
  EXPECT_NEAR(variance, 2.0 * frames, 0.02 * 2 * frames);
  EXPECT_NE(exposed(d, 0.0f, exposure(1, "other")).pixels, exposed(d, 0.0f, exposure()).pixels);
}

TEST(ReadNoiseSpread, OfNoneIsTheNoiseAsBefore) {
  EXPECT_EQ(exposed(with_spread(0.0), 50.0f, exposure()).pixels,
            exposed(detector_of({.read_noise_e = 1.5, .gain_e_per_dn = 0.01, .bias_dn = 2000}),
                    50.0f, exposure())
                .pixels);
  Detector none = with_spread(2.0);
  none.read_noise_e = 0.0;
  for (const auto c : exposed(none, 0.0f, exposure()).pixels) ASSERT_EQ(c, 2000);
}

Detector patterned() {
  Detector d = detector_of({.gain_e_per_dn = 0.05, .bias_dn = 2000});
  d.pixel_gain_rms = 0.01;
  d.column_gain_rms = 0.004;
  d.pixel_offset_e = 3.0;
  d.column_offset_e = 2.0;
  return d;
}

struct Parts {
  double mean = 0.0, of_columns = 0.0, of_pixels = 0.0;  // rms
};

Parts parts_of(const CountImage& counts) {
  std::vector<double> sums(columns);
  double all = 0.0, squares = 0.0;
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x) {
      const double e = 0.05 * (counts.at(x, y) - 2000.0);
      sums[std::size_t(x)] += e / rows;
      all += e / pixels;
    }
  for (int y = 0; y < rows; ++y)
    for (int x = 0; x < columns; ++x)
      squares += std::pow(0.05 * (counts.at(x, y) - 2000.0) - sums[std::size_t(x)], 2);
  double between = 0.0;
  for (const double s : sums) between += std::pow(s - all, 2) / columns;
  const double within2 = squares / pixels * rows / (rows - 1.0);
  return {all, std::sqrt(between - within2 / rows), std::sqrt(within2)};
}

// EMVA 1288's way: variances of pixels and of columns at two levels of light. An rms of n values is
// known to 1 / sqrt(2 n) of itself.
TEST(FixedPattern, HasTheRmsOfItsGainsAndOffsets) {
  for (const double light_e : {0.0, 1000.0}) {
    const Parts parts = parts_of(exposed(patterned(), float(light_e), exposure()));
    const double column_e = std::hypot(0.004 * light_e, 2.0);
    const double pixel_e = std::hypot(0.01 * light_e, 3.0);
    EXPECT_NEAR(parts.mean, light_e, 4 * column_e / std::sqrt(columns));
    EXPECT_NEAR(parts.of_columns, column_e, 4 * column_e / std::sqrt(2.0 * columns));
    EXPECT_NEAR(parts.of_pixels, pixel_e, 4 * pixel_e / std::sqrt(2.0 * pixels) + 1e-3);
  }
}

TEST(FixedPattern, IsTheSameInEveryFrameOfTheSensorAlone) {
  const CountImage first = exposed(patterned(), 800.0f, exposure(1));
  EXPECT_EQ(first.pixels, exposed(patterned(), 800.0f, exposure(2)).pixels);
  EXPECT_EQ(first.pixels, exposed(patterned(), 800.0f, exposure(1), 3).pixels);
  EXPECT_NE(first.pixels, exposed(patterned(), 800.0f, exposure(1, "other")).pixels);
  Threads one(1);
  const auto signal = expected_signal(ExpectedElectronImage(columns, rows, 800.0f), patterned(),
                                      exposure(), {}, one);
  for (std::size_t i = 0; i < signal.pixels.size(); ++i)
    ASSERT_NEAR(signal.pixels[i], 0.05 * (first.pixels[i] - 2000.0), 0.026);
}

TEST(FixedPattern, OfNoneIsNone) {
  EXPECT_FALSE(applies(detector_of({}), FixedPattern::facts));
  Detector d = patterned();
  EXPECT_TRUE(applies(d, FixedPattern::facts));
  EffectSet off;
  off.set(FixedPattern::facts, false);
  EXPECT_FALSE(applies(acting_detector(d, off), FixedPattern::facts));
}

}  // namespace
}  // namespace dmise
