#include "core/detector/brighter_fatter.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/detector/exposure/expected_signal.h"
#include "tests/support/detector_of.h"

namespace dmise {
namespace {

const Exposure exposure{.seed = 1, .sensor = "s", .frame = 1, .exposure_s = 1.0};

ElectronImage widened(const ExpectedElectronImage& light, double per_e) {
  Detector d = detector_of({});
  d.brighter_fatter_per_e = per_e;
  Threads one(1);
  return expected_signal(light, d, exposure, {}, one);
}

/// A Gaussian on pixel 12 of 25 x 25 whose brightest pixel has `peak_e`.
ExpectedElectronImage spot(double fwhm_px, double peak_e) {
  const double scale = fwhm_px / 2.354820045 * std::sqrt(2.0);
  const auto share = [&](int i) {
    return 0.5 * (std::erf((i - 11.5) / scale) - std::erf((i - 12.5) / scale));
  };
  ExpectedElectronImage light(25, 25);
  for (int y = 0; y < 25; ++y)
    for (int x = 0; x < 25; ++x)
      light.at(x, y) = float(peak_e * share(x) * share(y) / (share(12) * share(12)));
  return light;
}

template <class AnImage>
double total(const AnImage& image) {
  return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0);
}

/// Mean of both second moments [px^2].
template <class AnImage>
double moment(const AnImage& image) {
  double sum = 0.0;
  for (int y = 0; y < 25; ++y)
    for (int x = 0; x < 25; ++x)
      sum += image.at(x, y) * (std::pow(x - 12, 2) + std::pow(y - 12, 2)) / 2;
  return sum / total(image);
}

double growth(double fwhm_px, double peak_e, double per_e) {
  const auto light = spot(fwhm_px, peak_e);
  return (moment(widened(light, per_e)) - moment(light)) / peak_e;
}

// Reference: galsim.SiliconSensor, lsst_itl_8, tests/reference/brighter_fatter.py: mean of x and y,
// each +- 5 to 10 %. One coefficient, by the spot of 3 px, for all widths.
TEST(BrighterFatter, SpotsGrowAsInGalSimsSilicon) {
  constexpr double per_e = 1.89e-7;
  EXPECT_NEAR(growth(2, 8e4, per_e), 0.956e-7, 0.1 * 0.956e-7);
  EXPECT_NEAR(growth(3, 8e4, per_e), 1.41e-7, 0.02 * 1.41e-7);
  EXPECT_NEAR(growth(4, 8e4, per_e), 1.74e-7, 0.1 * 1.74e-7);
  EXPECT_NEAR(growth(6, 8e4, per_e), 2.02e-7, 0.1 * 2.02e-7);
}

TEST(BrighterFatter, GrowthIsLinearInLightAndCoefficient) {
  const double slope = growth(3, 8e4, 1e-7);
  EXPECT_NEAR(growth(3, 4e4, 1e-7), slope, 2e-3 * slope);
  EXPECT_NEAR(growth(3, 2e4, 1e-7), slope, 1e-2 * slope);
  EXPECT_NEAR(growth(3, 8e4, 3e-7), 3 * slope, 3e-3 * slope);
}

TEST(BrighterFatter, KeepsChargeAndSymmetry) {
  const auto light = spot(3, 8e4);
  const auto image = widened(light, 1e-6);
  EXPECT_NEAR(total(image), total(light), 1e-6 * total(light));
  for (int k = 1; k < 12; ++k) {
    EXPECT_NEAR(image.at(12 - k, 12), image.at(12 + k, 12), 0.02) << k;
    EXPECT_NEAR(image.at(12, 12 - k), image.at(12 + k, 12), 0.02) << k;
  }
}

TEST(BrighterFatter, EvenLightStaysEven) {
  for (const auto& [columns, rows] : {std::pair{37, 29}, {1, 50}, {50, 1}, {1, 1}, {3, 2}}) {
    const auto image = widened(ExpectedElectronImage(columns, rows, 5e4f), 1e-6);
    for (const float e : image.pixels) ASSERT_NEAR(e, 5e4, 0.02) << columns << " x " << rows;
  }
}

// Shot noise of flat light is smaller, by what neighbours take: Guyonnet et al. 2015. Pieces and
// threads do not matter.
TEST(BrighterFatter, FlatLightHasLessVarianceAndTheSameBytes) {
  Detector d = detector_of({.gain_e_per_dn = 2.0});
  d.brighter_fatter_per_e = 5e-7;
  const ExpectedElectronImage light(301, 211, 6e4f);
  const auto variance = [&](double per_e, int thread_count, CountImage& counts) {
    d.brighter_fatter_per_e = per_e;
    Threads threads(thread_count);
    expose(light, d, exposure, {}, threads, counts);
    double sum = 0.0, squares = 0.0;
    for (const auto c : counts.pixels) {
      sum += c;
      squares += double(c) * c;
    }
    const double mean = sum / double(counts.pixels.size());
    return (squares / double(counts.pixels.size()) - mean * mean) * 4.0;
  };
  CountImage one, three, none;
  const double with = variance(5e-7, 1, one), without = variance(0.0, 1, none);
  variance(5e-7, 3, three);
  EXPECT_EQ(one.pixels, three.pixels);
  EXPECT_NEAR(without, 6e4, 0.02 * 6e4);
  // Each of four boundaries takes a half of per_e Q of what the pixel has more than its neighbours.
  EXPECT_LT(with, 0.96 * without);
  EXPECT_GT(with, 0.80 * without);
}

TEST(BrighterFatter, ACoefficientThatTurnsPixelsInsideOutIsRefused) {
  Detector d = detector_of({.full_well_e = 1e5});
  d.brighter_fatter_per_e = 2.6e-6;
  const auto fault = fault_of(d);
  ASSERT_TRUE(fault);
  EXPECT_EQ(fault->key, "brighter_fatter_per_e");
}

}  // namespace
}  // namespace dmise
