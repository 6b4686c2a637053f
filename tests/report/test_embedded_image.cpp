#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/report/embedded_image.h"
#include "tests/report/inflated.h"

namespace dmise {
namespace {

std::vector<double> values_of(const EmbeddedImage& image) {
  const auto size = std::size_t(image.columns) * std::size_t(image.rows);
  const std::string bytes = inflated(image.pixels, 2 * size);
  std::vector<double> values;
  std::vector<unsigned> numbers;
  for (std::size_t i = 0; i < size; ++i) {
    const auto x = i % std::size_t(image.columns);
    const unsigned before = x > 0 ? numbers[i - 1]
                            : i >= std::size_t(image.columns)
                                ? numbers[i - std::size_t(image.columns)]
                                : 0;
    const unsigned difference = (unsigned(bytes[i]) & 255u) | (unsigned(bytes[size + i]) & 255u)
                                                                  << 8;
    numbers.push_back((before + difference) & 0xffffu);
    values.push_back(image.min_dn + image.step_dn * numbers.back());
  }
  return values;
}

CountImage noise(int columns, int rows, double mean, double sigma) {
  CountImage counts(columns, rows);
  std::mt19937 random(7);
  std::normal_distribution<double> normal(mean, sigma);
  for (auto& c : counts.pixels) c = std::uint16_t(std::clamp(normal(random), 0.0, 65535.0));
  return counts;
}

TEST(EmbeddedImage, HoldsEachPixelOfASmallFrameToATenthOfItsNoise) {
  CountImage counts = noise(101, 67, 1000.0, 30.0);
  counts.at(100, 66) = 65535;
  counts.at(0, 0) = 0;
  const EmbeddedImage image = embed(counts, 10'000);
  ASSERT_EQ(image.bin, 1);
  ASSERT_EQ(image.columns, 101);
  const auto values = values_of(image);
  double squares = 0.0;
  for (std::size_t i = 0; i < values.size(); ++i) {
    const double error = values[i] - counts.pixels[i];
    EXPECT_LE(std::abs(error), image.step_dn / 2 + 1e-6);
    squares += error * error;
  }
  // Steps of a third: uniform errors of sigma / 3 / sqrt(12).
  EXPECT_NEAR(std::sqrt(squares / double(values.size())), 30.0 / 3 / std::sqrt(12.0), 1.0);
}

TEST(EmbeddedImage, AveragesWhatIsLargerThanItMayBe) {
  const CountImage counts = noise(331, 250, 500.0, 10.0);
  const EmbeddedImage image = embed(counts, 5'000);
  EXPECT_LE(image.columns * image.rows, 5'000);
  EXPECT_EQ(image.columns, (331 + image.bin - 1) / image.bin);
  const auto values = values_of(image);
  // The last mean is of the pixels that are left.
  double sum = 0.0;
  int pixels = 0;
  for (int y = (image.rows - 1) * image.bin; y < 250; ++y)
    for (int x = (image.columns - 1) * image.bin; x < 331; ++x) sum += counts.at(x, y), ++pixels;
  EXPECT_NEAR(values.back(), sum / pixels, image.step_dn / 2 + 1e-4);
}

TEST(EmbeddedImage, HoldsAFrameOfEqualCountsAndOneOfOnePixel) {
  EXPECT_EQ(values_of(embed(CountImage(20, 10, 77), 1'000)).front(), 77.0);
  EXPECT_EQ(values_of(embed(CountImage(1, 1, 5), 1)).front(), 5.0);
  const auto wide = values_of(embed(CountImage(10, 10, 65535), 1'000));
  EXPECT_EQ(wide.back(), 65535.0);
}

}  // namespace
}  // namespace dmise
