#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/base/numeric/rng.h"
#include "core/base/units.h"
#include "core/optics/blur/blur_grid.h"
#include "core/optics/blur/deposit.h"
#include "tests/optics/kernels.h"

namespace dmise {
namespace {

constexpr double lambda = 0.55e-6, diameter = 0.3;
const Blur airy{.wavelength_m = lambda, .aperture_m = diameter};

double sum(const ExpectedElectronImage& image) {
  return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0);
}

/// An image on a grid of one cell a pixel, blurred.
void blur(ExpectedElectronImage& image, const PsfKernel& kernel, Threads& threads, BlurGrid& grid) {
  grid.set_kernels({kernel}, threads);
  const DepositView cells = grid.cells();
  for (int y = 0; y < image.rows; ++y)
    std::copy_n(image.row(y), image.columns,
                cells.pixels + std::size_t(y + cells.top) * std::size_t(cells.stride) + cells.left);
  std::fill(image.pixels.begin(), image.pixels.end(), 0.0f);
  grid.blur_into(image, PointSpread::Resampling::area, threads);
}
void blur(ExpectedElectronImage& image, const PsfKernel& kernel, Threads& threads) {
  BlurGrid grid(image.columns, image.rows, 1, kernel.half);
  blur(image, kernel, threads, grid);
}

/// Fraction of the light within `radius` cells of the centre; cells cut by the circle count by the
/// fraction of 16 x 16 points inside.
double encircled_energy(const PsfKernel& kernel, double radius) {
  constexpr int points = 16;
  double sum = 0.0;
  for (int dy = -kernel.half; dy <= kernel.half; ++dy)
    for (int dx = -kernel.half; dx <= kernel.half; ++dx) {
      const double r = std::hypot(dx, dy);
      int inside = r + 0.75 <= radius ? points * points : 0;
      if (inside == 0 && r - 0.75 <= radius)
        for (int j = 0; j < points; ++j)
          for (int i = 0; i < points; ++i)
            inside +=
                std::hypot(dx + (i + 0.5) / points - 0.5, dy + (j + 0.5) / points - 0.5) <= radius;
      sum += kernel.at(dx, dy) * double(inside) / (points * points);
    }
  return sum;
}

// Born & Wolf: first zero at 1.2197 lambda/D with 83.8 % of the light inside, 91.0 % within the
// second at 2.2331.
TEST(PsfKernel, OfAClearApertureIsTheAiryPattern) {
  const double cell = 0.05 * lambda / diameter;
  double lost = 0;
  PsfKernel k = optical_kernel(airy, cell, 300, &lost);
  EXPECT_NEAR(lost, 0.2 / 15, 0.004);  // beyond 15 lambda/D: about 0.2 / radius
  for (float& v : k.values) v *= float(1 - lost);
  EXPECT_NEAR(encircled_energy(k, 1.2197 / 0.05), 0.838, 0.002);
  EXPECT_NEAR(encircled_energy(k, 2.2331 / 0.05), 0.910, 0.002);
  int darkest = 1;
  for (int x = 1; x < 40; ++x)
    if (k.at(x, 0) < k.at(darkest, 0)) darkest = x;
  EXPECT_NEAR(darkest * 0.05, 1.2197, 0.05);
  // The peak of the diffraction-limited pattern, pi/4 (D/lambda)^2 a steradian, over the central
  // cell.
  EXPECT_NEAR(k.at(0, 0), pi / 4 * 0.05 * 0.05, 2e-3 * pi / 4 * 0.05 * 0.05);
}

TEST(PsfKernel, CellsMuchLargerThanThePatternHoldAllOfIt) {
  const PsfKernel k = optical_kernel(airy, 40 * lambda / diameter, 2);
  EXPECT_GT(k.at(0, 0), 0.98);
  EXPECT_NEAR(std::accumulate(k.values.begin(), k.values.end(), 0.0), 1.0, 1e-6);
}

TEST(PsfKernel, SumsToOneFromOneMillimetreOfSeeingToNone) {
  for (double r0 : {1e-3, 0.05, 0.3, 100.0, std::numeric_limits<double>::infinity()}) {
    Blur b = airy;
    b.r0_m = r0;
    const double cell = 0.25 * std::hypot(lambda / diameter, lambda / r0);
    double lost = 0;
    const PsfKernel k = optical_kernel(b, cell, 64, &lost);
    EXPECT_NEAR(std::accumulate(k.values.begin(), k.values.end(), 0.0), 1.0, 1e-6) << r0;
    EXPECT_LT(std::abs(lost), 0.03) << r0;
    for (float v : k.values) ASSERT_GE(v, 0.0f);
  }
}

// Reference: direct sums over the kernel.
TEST(BlurGrid, IsTheConvolutionAlsoForPrimeAndTinyFrames) {
  Threads one(1);
  const PsfKernel k = optical_kernel(airy, 0.5 * lambda / diameter, 9);
  for (auto [columns, rows] : {std::pair{101, 67}, {1, 40}, {40, 1}, {1, 1}, {8, 120}}) {
    ExpectedElectronImage image(columns, rows), expected(columns, rows);
    const RngKey key = rng_key(1, "s", 1, "e");
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      image.pixels[i] =
          i % 7 == 0 ? float(1000 * uniform_of(rng_word(key, std::uint32_t(i), 0))) : 0.0f;
    for (int y = 0; y < rows; ++y)
      for (int x = 0; x < columns; ++x) {
        double s = 0;
        for (int dy = -9; dy <= 9; ++dy)
          for (int dx = -9; dx <= 9; ++dx)
            if (x - dx >= 0 && x - dx < columns && y - dy >= 0 && y - dy < rows)
              s += double(k.at(dx, dy)) * image.at(x - dx, y - dy);
        expected.at(x, y) = float(s);
      }
    blur(image, k, one);
    for (std::size_t i = 0; i < image.pixels.size(); ++i)
      ASSERT_NEAR(image.pixels[i], expected.pixels[i], 1e-3);
  }
}

TEST(BlurGrid, KeepsTheFluxNeverGoesNegativeAndWrapsNothingAround) {
  Threads one(1);
  const PsfKernel k = optical_kernel(airy, 0.5 * lambda / diameter, 40);
  ExpectedElectronImage image(400, 300);
  image.at(200, 150) = 1e6f;
  image.at(120, 80) = 10.0f;
  blur(image, k, one);
  EXPECT_NEAR(sum(image) / (1e6 + 10), 1.0, 1e-6);
  for (float e : image.pixels) ASSERT_GE(e, 0.0f);

  // In the last column: what leaves on the right does not come back on the left.
  ExpectedElectronImage edge(400, 300);
  edge.at(399, 299) = 1e6f;
  blur(edge, k, one);
  for (int y = 0; y < 250; ++y)
    for (int x = 0; x < 350; ++x) ASSERT_LT(edge.at(x, y), 0.2f) << x << " " << y;
  EXPECT_LT(sum(edge), 0.5e6);
  EXPECT_GT(sum(edge), 0.25e6);
}

TEST(BlurGrid, TheBytesDoNotDependOnThreadsAndUseAgain) {
  const PsfKernel k = optical_kernel(airy, 0.5 * lambda / diameter, 20);
  ExpectedElectronImage light(503, 331);
  const RngKey key = rng_key(1, "s", 1, "e");
  for (std::size_t i = 0; i < light.pixels.size(); ++i)
    light.pixels[i] = float(uniform_of(rng_word(key, std::uint32_t(i), 0)));
  Threads one(1);
  ExpectedElectronImage reference = light;
  blur(reference, k, one);
  for (int n : {1, 2, 4}) {
    Threads threads(n);
    BlurGrid grid(503, 331, 1, k.half);
    for (int again = 0; again < 2; ++again) {
      ExpectedElectronImage image = light;
      blur(image, k, threads, grid);
      ASSERT_EQ(image.pixels, reference.pixels) << n;
    }
  }
}

// The analytic deposit against 16 x finer cells through the transform and summed.
TEST(BlurGrid, AnalyticDepositAgreesWithASixteenTimesFinerTransform) {
  Threads one(1);
  for (double sigma_px : {0.3, 0.7, 1.5}) {
    const int fine = 16, side = 24, half = int(std::ceil(5.5 * sigma_px * fine));
    const auto gaussian = [&](double nu_x, double nu_y) {
      return jitter_otf(std::hypot(nu_x, nu_y), sigma_px * fine);
    };
    const PsfKernel k = kernel_of(gaussian, 0.5, 1.0, half);
    ExpectedElectronImage grid(side * fine, side * fine);
    const int u = 11 * fine + 5, v = 12 * fine + 13;
    grid.at(u, v) = 1.0f;
    blur(grid, k, one);
    ExpectedElectronImage direct(side, side);
    const PixelPosition at{(u + 0.5) / fine - 0.5, (v + 0.5) / fine - 0.5};
    const Arc point{at, at, at, 1.0};
    deposit(std::span(&point, 1), make_psf_table(sigma_px), view_of(direct), one);
    for (int y = 0; y < side; ++y)
      for (int x = 0; x < side; ++x) {
        double s = 0;
        for (int j = 0; j < fine; ++j)
          for (int i = 0; i < fine; ++i) s += grid.at(x * fine + i, y * fine + j);
        EXPECT_NEAR(direct.at(x, y), s, 1e-4) << sigma_px;
      }
  }
}

}  // namespace
}  // namespace dmise
