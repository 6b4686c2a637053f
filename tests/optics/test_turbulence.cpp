#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/base/units.h"
#include "core/optics/waves/pupil.h"
#include "tests/optics/kernels.h"

namespace dmise {
namespace {

constexpr double lambda = 0.55e-6;

/// Two independent screens of the fields and tilts of one draw.
std::array<PhaseScreen, 2> drawn(KolmogorovScreens& screens, const RngKey& key, std::uint32_t draw,
                                 double r0_samples) {
  std::array<std::vector<float>, 2> fields;
  const auto tilts = screens.draw_fields(key, draw, fields[0], fields[1]);
  const double scale = std::pow(r0_samples, -5.0 / 6);  // factor of the phase: D goes as r0^(-5/3)
  std::array<PhaseScreen, 2> pair;
  for (std::size_t part = 0; part < 2; ++part) {
    pair[part].side = screens.side();
    for (int y = 0; y < screens.side(); ++y)
      for (int x = 0; x < screens.side(); ++x) {
        const auto at = std::size_t(y) * std::size_t(screens.torus()) + std::size_t(x);
        pair[part].phase_rad.push_back(
            float(scale * (fields[part][at] + tilts[part].x * x + tilts[part].y * y)));
      }
  }
  return pair;
}

/// Instantaneous kernel |F{A exp(i phi)}|^2 through a screen sampled at the grid's step, integrated
/// over cells; null: no turbulence.
PsfKernel short_exposure_kernel(const Pupil& pupil, const PupilGrid& grid, int half,
                                const PhaseScreen* screen) {
  const SampledOtf cells(grid, [&](double nu_x, double nu_y) {
    return pixel_otf(nu_x, grid.cell_rad) * pixel_otf(nu_y, grid.cell_rad);
  });
  return without_negatives(pupil_kernel(pupil, grid, half, {screen, grid.step_m}, cells));
}

// Kolmogorov's 6.88 (r / r0)^(5/3), from the amplitudes that screens are made with.
TEST(PhaseScreen, ExpectedStructureFunctionIsKolmogorovsFromOneSampleToTheWholeScreen) {
  const KolmogorovScreens screens(64);
  for (auto [dx, dy] : {std::pair{1, 0},
                        {0, 1},
                        {1, 1},
                        {2, 0},
                        {4, 0},
                        {3, 4},
                        {21, 0},
                        {0, 21},
                        {40, 30},
                        {63, 0},
                        {63, 63}}) {
    const double expected = kolmogorov_structure(std::hypot(dx, dy), 1.0);
    EXPECT_NEAR(screens.expected_structure(dx, dy) / expected, 1.0, 1e-3) << dx << " " << dy;
  }
}

TEST(PhaseScreen, DrawnScreensHaveIt) {
  KolmogorovScreens screens(48);
  const RngKey key = rng_key(3, "s", 1, "turbulence");
  const int pairs = 60;
  for (int r : {1, 4, 16, 47}) {
    double sum = 0, sum2 = 0;
    int count = 0;
    for (int k = 0; k < pairs; ++k)
      for (const PhaseScreen& s : drawn(screens, key, std::uint32_t(k), 5.0)) {
        double d = 0;
        int n = 0;
        for (int y = 0; y < 48; y += 4)
          for (int x = 0; x + r < 48; x += 4) d += std::pow(s.at(x + r, y) - s.at(x, y), 2), ++n;
        sum += d / n, sum2 += d / n * d / n, ++count;
      }
    const double mean = sum / count, sigma = std::sqrt((sum2 / count - mean * mean) / count);
    EXPECT_NEAR(mean, kolmogorov_structure(r, 5.0), 4 * sigma) << r;
  }
}

TEST(Pupil, WithoutTurbulenceTheKernelIsThatOfTheTransferFunction) {
  const Pupil pupil{.aperture_m = 0.3, .obscuration = 0.3};
  const double cell = 0.6 * lambda / 0.3;
  const double inf = std::numeric_limits<double>::infinity();
  const PupilGrid grid = pupil_grid(pupil, lambda, cell, 24, inf);
  const PsfKernel a = short_exposure_kernel(pupil, grid, 24, nullptr);
  const PsfKernel b =
      optical_kernel({.wavelength_m = lambda, .aperture_m = 0.3, .obscuration = 0.3}, cell, 24);
  EXPECT_NEAR(std::accumulate(a.values.begin(), a.values.end(), 0.0), 1.0, 1e-6);
  for (std::size_t i = 0; i < a.values.size(); ++i)
    ASSERT_NEAR(a.values[i], b.values[i], 0.01 * b.at(0, 0)) << i;
}

// Fried 1966: mean of short exposures = diffraction times long exposure, D / r0 = 4. The transfer
// functions are compared along x.
TEST(Turbulence, MeanOfShortExposuresIsTheLongExposure) {
  const Pupil pupil{.aperture_m = 0.4};
  const double r0 = 0.1, cell = 0.7 * lambda / pupil.aperture_m;
  const int half = 30;
  const PupilGrid grid = pupil_grid(pupil, lambda, cell, half, r0);
  KolmogorovScreens screens(aperture_samples(pupil, grid));
  const RngKey key = rng_key(5, "s", 1, "turbulence");
  PsfKernel mean{half, std::vector<float>(std::size_t(2 * half + 1) * std::size_t(2 * half + 1))};
  constexpr std::uint32_t pairs = 80;
  for (std::uint32_t k = 0; k < pairs; ++k)
    for (const PhaseScreen& s : drawn(screens, key, k, r0 / grid.step_m)) {
      const PsfKernel kernel = short_exposure_kernel(pupil, grid, half, &s);
      for (std::size_t i = 0; i < mean.values.size(); ++i)
        mean.values[i] += kernel.values[i] / float(2 * pairs);
    }
  for (double share : {0.05, 0.1, 0.2, 0.3, 0.5, 0.7}) {
    const double nu = share * pupil.aperture_m / lambda;
    double h = 0;
    for (int dy = -half; dy <= half; ++dy)
      for (int dx = -half; dx <= half; ++dx)
        h += mean.at(dx, dy) * std::cos(2 * pi * nu * dx * cell);
    const double expected =
        diffraction_otf(nu, lambda, 0.4) * long_exposure_otf(nu, lambda, r0) * pixel_otf(nu, cell);
    EXPECT_NEAR(h, expected, 0.02) << share;
  }
}

TEST(Pupil, AShortExposureKeepsItsLightFromWeakToStrongTurbulence) {
  for (double strength : {0.01, 1.0, 10.0, 25.0}) {  // D / r0
    const Pupil pupil{.aperture_m = 0.4, .spiders = 4, .spider_width_m = 0.01};
    const double r0 = 0.4 / strength;
    const double cell = 0.5 * lambda / std::min(0.4, r0);
    const PupilGrid grid = pupil_grid(pupil, lambda, cell, 8, r0);
    KolmogorovScreens screens(aperture_samples(pupil, grid));
    const auto pair = drawn(screens, rng_key(1, "s", 1, "t"), 0, r0 / grid.step_m);
    const PsfKernel k = short_exposure_kernel(pupil, grid, 8, &pair[1]);
    EXPECT_NEAR(std::accumulate(k.values.begin(), k.values.end(), 0.0), 1.0, 1e-6);
    for (float v : k.values) ASSERT_GE(v, 0.0f);
  }
}

// Noll 1976, table I.
TEST(Zernike, TermsAreNolls) {
  const double r = 0.7, t = 0.4;
  EXPECT_NEAR(zernike(1, r, t), 1.0, 1e-14);
  EXPECT_NEAR(zernike(2, r, t), 2 * r * std::cos(t), 1e-14);
  EXPECT_NEAR(zernike(3, r, t), 2 * r * std::sin(t), 1e-14);
  EXPECT_NEAR(zernike(4, r, t), std::sqrt(3) * (2 * r * r - 1), 1e-14);
  EXPECT_NEAR(zernike(5, r, t), std::sqrt(6) * r * r * std::sin(2 * t), 1e-14);
  EXPECT_NEAR(zernike(6, r, t), std::sqrt(6) * r * r * std::cos(2 * t), 1e-14);
  EXPECT_NEAR(zernike(7, r, t), std::sqrt(8) * (3 * r * r * r - 2 * r) * std::sin(t), 1e-14);
  EXPECT_NEAR(zernike(8, r, t), std::sqrt(8) * (3 * r * r * r - 2 * r) * std::cos(t), 1e-14);
  EXPECT_NEAR(zernike(9, r, t), std::sqrt(8) * r * r * r * std::sin(3 * t), 1e-14);
  EXPECT_NEAR(zernike(11, r, t), std::sqrt(5) * (6 * std::pow(r, 4) - 6 * r * r + 1), 1e-14);
}

// A wavefront error of 1 rad rms leaves a Strehl ratio of about exp(-1) (Mahajan 1983).
TEST(Zernike, AWavefrontErrorCostsTheStrehlRatioThatMahajanGives) {
  const double cell = 0.2 * lambda / 0.3, inf = std::numeric_limits<double>::infinity();
  Pupil pupil{.aperture_m = 0.3};
  const PupilGrid grid = pupil_grid(pupil, lambda, cell, 60, inf);
  const double peak = short_exposure_kernel(pupil, grid, 60, nullptr).at(0, 0);
  for (int noll : {4, 6}) {
    pupil.wavefront = {{noll, 0.5}};
    const double blurred = short_exposure_kernel(pupil, grid, 60, nullptr).at(0, 0);
    EXPECT_NEAR(blurred / peak, std::exp(-0.25), 0.02) << noll;
  }
}

}  // namespace
}  // namespace dmise
