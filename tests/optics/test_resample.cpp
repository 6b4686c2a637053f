#include <gtest/gtest.h>

#include <cmath>
#include <complex>
#include <numeric>

#include "core/base/rng.h"
#include "core/base/units.h"
#include "core/optics/otf.h"
#include "core/optics/resample.h"

namespace dmise {
namespace {

double sum(const ExpectedElectronImage& image) {
  return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0);
}

/// A wave along x that averages over each pixel of `columns` across a field of unit width.
ExpectedElectronImage wave(int columns, double cycles) {
  ExpectedElectronImage image(columns, 1);
  for (int x = 0; x < columns; ++x)
    image.at(x, 0) = float((2.0 + std::cos(2 * pi * cycles * (x + 0.5) / columns)) / columns);
  return image;
}

/// Its modulation.
double modulation(const ExpectedElectronImage& image, double cycles) {
  std::complex<double> wave_part, mean;
  for (int x = 0; x < image.columns; ++x) {
    wave_part +=
        double(image.at(x, 0)) * std::polar(1.0, -2 * pi * cycles * (x + 0.5) / image.columns);
    mean += image.at(x, 0);
  }
  return 2 * std::abs(wave_part) / std::abs(mean) * 2.0;
}

TEST(Resample, ByAreaKeepsEveryElectron) {
  ExpectedElectronImage image(120, 90);
  const RngKey key = rng_key(1, "s", 1, "e");
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    image.pixels[i] = float(uniform_of(rng_word(key, std::uint32_t(i), 0)));
  for (auto [columns, rows] : {std::pair{60, 45}, {40, 30}, {97, 71}, {1, 1}, {200, 150}})
    EXPECT_NEAR(sum(resample_area(image, columns, rows)) / sum(image), 1.0, 1e-6);
}

TEST(Resample, BilinearLosesOrWinsTheLightOfAPointByWhereItLies) {
  // At three cells a pixel: all of a lone cell's light is multiplied by nine in the centre, and
  // none of it arrives from elsewhere. At two cells a pixel every cell counts once.
  ExpectedElectronImage centre(30, 30), side(30, 30);
  centre.at(13, 13) = side.at(14, 13) = 1.0f;
  EXPECT_NEAR(sum(resample_bilinear(centre, 10, 10)), 9.0, 1e-6);
  EXPECT_EQ(sum(resample_bilinear(side, 10, 10)), 0.0);
  EXPECT_NEAR(sum(resample_bilinear(side, 15, 15)), 1.0, 1e-6);
}

// A wave on cells, averaged over pixels: sinc of the pixel, and of the cell for bilinear between
// cells at all phases (the pixels' own blur left out).
TEST(Resample, TheTransferFunctionsAreThoseStated) {
  const int cells = 4096;
  for (double cycles : {20.0, 100.0, 200.0}) {
    const ExpectedElectronImage image = wave(cells, cycles);
    EXPECT_NEAR(modulation(resample_area(image, 1024, 1), cycles),
                std::abs(pixel_otf(cycles, 4.0 / cells) / pixel_otf(cycles, 1.0 / cells)), 1e-3);
    // 4096 / 1365 = 3.0007: the centres pass through all phases between two cells.
    const double nu = pi * cycles / cells;
    EXPECT_NEAR(modulation(resample_bilinear(image, 1365, 1), cycles),
                std::pow(std::sin(nu) / nu, 2), 2e-2 * nu);
    EXPECT_NEAR(modulation(resample_bilinear(image, 2048, 1), cycles), std::cos(nu), 1e-3);
  }
}

}  // namespace
}  // namespace dmise
