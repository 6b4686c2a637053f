#include <gtest/gtest.h>

#include <cmath>
#include <numeric>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/optics/blur/blur_grid.h"
#include "core/optics/blur/direct_blur.h"
#include "core/optics/projection.h"
#include "core/optics/psf_model.h"

// Points and streaks through the two ways of blurring them, against the analytic deposit and one
// another.
namespace dmise {
namespace {

using Method = PointSpread::Method;

/// A Gaussian of `fwhm_px` on a frame, at `oversampling` cells a pixel.
Optics gaussian(int columns, int rows, double fwhm_px, int oversampling) {
  Optics o{.focal_length_m = 1.0,
           .aperture_m = 1e3,  // diffraction adds nothing
           .pixel_pitch_m = 1e-5,
           .columns = columns,
           .rows = rows,
           .psf_fwhm_px = fwhm_px};
  o.equivalent_aperture = true;
  o.spread.method = Method::transform;
  o.spread.oversampling = oversampling;
  return o;
}

Optics telescope(int columns, int rows) {
  Optics o{.focal_length_m = 4.0,
           .aperture_m = 0.4,
           .obscuration = 0.3,
           .pixel_pitch_m = 4.39e-6,  // 0.798 cycles a pixel: the most for two cells
           .columns = columns,
           .rows = rows};
  o.spread.model = PointSpread::Model::diffraction;
  o.spread.support_px = 20;
  return o;
}

constexpr double lambda = 0.55e-6;

PsfKernel kernel_of_camera(const Optics& o, const PsfPlan& plan,
                           const std::optional<SensorSeeing>& seeing = {}, double start_s = 0.0,
                           double exposure_s = 1.0) {
  PsfModel model(o, {{lambda, 1.0}}, plan, seeing, rng_key(1, "s", 0, "turbulence"));
  return model.kernel({}, start_s, exposure_s);
}

ExpectedElectronImage by_transform(const Optics& o, std::span<const Arc> arcs, Threads& threads) {
  const PsfPlan plan = plan_psf(o, lambda, {}, 1.0);
  BlurGrid grid(o.columns, o.rows, plan.oversampling, plan.half_cells);
  grid.set_kernels({kernel_of_camera(o, plan)}, threads);
  std::vector<Arc> on_cells;
  for (const Arc& arc : arcs) on_cells.push_back(grid.on_cells(arc));
  deposit(on_cells, make_psf_table(grid_sigma_cells), grid.cells(), threads);
  ExpectedElectronImage light(o.columns, o.rows);
  grid.blur_into(light, o.spread.resampling, threads);
  return light;
}

ExpectedElectronImage directly(const Optics& o, std::span<const Arc> arcs, Threads& threads) {
  const PsfPlan plan = plan_psf(o, lambda, {}, 1.0);
  DirectBlur blur(plan.oversampling, plan.half_cells, o.spread.resampling);
  blur.set_kernel(kernel_of_camera(o, plan));
  ExpectedElectronImage light(o.columns, o.rows);
  blur.deposit(arcs, light, threads);
  return light;
}

ExpectedElectronImage analytically(const Optics& o, std::span<const Arc> arcs, Threads& threads) {
  ExpectedElectronImage light(o.columns, o.rows);
  deposit(arcs, make_psf_table(psf_sigma_px(o, lambda)), view_of(light), threads);
  return light;
}

double sum(const ExpectedElectronImage& image) {
  return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0);
}

double greatest(const ExpectedElectronImage& image) {
  return *std::max_element(image.pixels.begin(), image.pixels.end());
}

double worst(const ExpectedElectronImage& a, const ExpectedElectronImage& b) {
  double d = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i)
    d = std::max(d, double(std::abs(a.pixels[i] - b.pixels[i])));
  return d;
}

PixelPosition centroid(const ExpectedElectronImage& image) {
  double e = 0, x = 0, y = 0;
  for (int r = 0; r < image.rows; ++r)
    for (int c = 0; c < image.columns; ++c) {
      e += image.at(c, r), x += double(c) * image.at(c, r), y += double(r) * image.at(c, r);
    }
  return {x / e, y / e};
}

Arc point(double x, double y, double e) { return {{x, y}, {x, y}, {x, y}, e}; }
Arc streak(PixelPosition a, PixelPosition b, double e, PixelPosition bend = {}) {
  return {a, (a + b) * 0.5 + bend, b, e};
}

// The analytic deposit is the reference; 16 cells a pixel, pixels larger and smaller than the blur.
TEST(Blur, AnalyticDepositAgreesWithASixteenTimesOversampledTransformTo1e4) {
  Threads one(1);
  for (double fwhm_px : {0.6, 1.5, 4.0}) {
    const Optics o = gaussian(48, 40, fwhm_px, 16);
    const Arc arcs[] = {point(11.37, 12.81, 1e4), streak({20.2, 25.1}, {37.7, 18.3}, 3e4),
                        streak({6.1, 30.2}, {15.4, 33.9}, 2e4, {0.4, -1.1})};
    for (const Arc& arc : arcs) {
      const ExpectedElectronImage reference = analytically(o, {&arc, 1}, one);
      const double peak = greatest(reference);
      EXPECT_LT(worst(by_transform(o, {&arc, 1}, one), reference), 1e-4 * peak) << fwhm_px;
      EXPECT_LT(worst(directly(o, {&arc, 1}, one), reference), 1e-4 * peak) << fwhm_px;
    }
  }
}

TEST(Blur, DirectSumsAndTheTransformAreOneConvolution) {
  Threads one(1);
  Optics o = telescope(96, 80);
  o.spread.spiders = 3;
  o.spread.spider_width_m = 0.02;
  o.spread.wavefront = {{7, 60e-9}, {5, 40e-9}};
  const Arc arcs[] = {point(40.3, 37.8, 1e4), streak({20.2, 25.1}, {67.7, 58.3}, 3e4)};
  for (int k : {0, 3, 4}) {
    o.spread.oversampling = k;
    const ExpectedElectronImage a = by_transform(o, arcs, one);
    ExpectedElectronImage b = directly(o, arcs, one);
    for (float& e : b.pixels) e = std::max(0.0f, e);
    EXPECT_LT(worst(a, b), 2e-6 * greatest(a)) << k;
  }
}

// The least oversampling that a plan takes, against four times as much: what aliasing and the taper
// of the kernel leave.
TEST(Blur, TheLeastOversamplingIsRightTo1e4OfThePeak) {
  Threads one(1);
  Optics o = telescope(96, 80);
  o.spread.support_px = 64;  // so that nothing of what the taper does is left
  const Arc arcs[] = {point(40.3, 37.8, 1e4), streak({20.2, 25.1}, {67.7, 58.3}, 3e4)};
  const ExpectedElectronImage coarse = directly(o, arcs, one);
  const int least = plan_psf(o, lambda, {}, 1.0).oversampling;
  EXPECT_EQ(least, 2);
  o.spread.oversampling = 4 * least;
  const ExpectedElectronImage fine = directly(o, arcs, one);
  RecordProperty("deviation", std::to_string(worst(coarse, fine) / greatest(fine)));
  EXPECT_LT(worst(coarse, fine), 1e-4 * greatest(fine));
}

// Light is where it was put, at every oversampling, on both paths: points, straight and curved.
TEST(Blur, RegistersPointsAndStreaksAtEveryOversampling) {
  Threads one(1);
  for (int k : {1, 2, 3, 4, 7, 8})
    for (const bool bilinear : {false, true}) {
      Optics o = gaussian(96, 80, 4.2, k);
      if (bilinear) o.spread.resampling = PointSpread::Resampling::bilinear;
      for (const Arc& arc : {point(40.31, 37.83, 1e4), streak({20.27, 25.1}, {67.7, 50.3}, 3e4),
                             streak({20.27, 25.1}, {67.7, 50.3}, 3e4, {1.3, -2.2})}) {
        // Mean of a parabola in time: Simpson's rule is exact.
        const PixelPosition mean = (arc.start + arc.middle * 4.0 + arc.end) * (1.0 / 6);
        for (const ExpectedElectronImage& image :
             {by_transform(o, {&arc, 1}, one), directly(o, {&arc, 1}, one)}) {
          const PixelPosition seen = centroid(image);
          EXPECT_NEAR(seen.x_px, mean.x_px, 0.002) << k << bilinear;
          EXPECT_NEAR(seen.y_px, mean.y_px, 0.002) << k << bilinear;
          EXPECT_NEAR(sum(image) / arc.signal_e, 1.0, 1e-6 + 1e-5 * bilinear) << k << bilinear;
        }
      }
    }
}

// Closed form of widths: the pixel's own variance, 1/12, and, where a pixel's value is that between
// its two middle cells (an even number of them), that of two places 1/k apart.
TEST(Blur, BilinearResamplingWidensByTheDistanceOfTheMiddleCells) {
  Threads one(1);
  const auto variance = [](const ExpectedElectronImage& image) {
    const PixelPosition mean = centroid(image);
    double sum = 0.0, square = 0.0;
    for (int y = 0; y < image.rows; ++y)
      for (int x = 0; x < image.columns; ++x) {
        sum += image.at(x, y);
        square += image.at(x, y) * (x - mean.x_px) * (x - mean.x_px);
      }
    return square / sum;
  };
  for (int k : {1, 2, 3, 4, 8})
    for (const bool bilinear : {false, true}) {
      Optics o = gaussian(96, 80, 4.2, k);
      if (bilinear) o.spread.resampling = PointSpread::Resampling::bilinear;
      const Arc arc = point(47.81, 39.83, 1e5);
      const double sigma_px = 4.2 / std::sqrt(8 * std::log(2));
      const double expected =
          sigma_px * sigma_px + 1.0 / 12 + (bilinear && k % 2 == 0 ? 1.0 / (4 * k * k) : 0.0);
      EXPECT_NEAR(variance(by_transform(o, {&arc, 1}, one)), expected, 2e-3) << k << bilinear;
      EXPECT_NEAR(variance(directly(o, {&arc, 1}, one)), expected, 2e-3) << k << bilinear;
    }
}

TEST(Blur, RegistersTheDirectionsOfEveryProjectionOnBothPaths) {
  Threads one(1);
  for (Projection projection : {Projection::gnomonic, Projection::equidistant,
                                Projection::equisolid, Projection::stereographic})
    for (int k : {1, 2, 3}) {
      Optics o = gaussian(300, 260, 4.2, k);
      o.projection = projection;
      o.focal_length_m = 150e-5;  // 90 deg over the width of a gnomonic lens
      const Vec<CameraFrame> axis = unit(Vec<CameraFrame>{0.1, -1.2, 0.4});
      for (double turn_deg : {0.0, 0.3, 5.0}) {
        const auto at = [&](double tau) {
          const Vec<CameraFrame> v = unit(Vec<CameraFrame>{0.41, 0.37, 1.0});
          const double a = (tau - 0.5) * turn_deg * deg;
          return *project(o, v * std::cos(a) + cross(axis, v) * std::sin(a) +
                                 axis * (dot(axis, v) * (1 - std::cos(a))));
        };
        const Arc arc{at(0), at(0.5), at(1), 1e5};
        PixelPosition mean;
        for (int i = 0; i < 4000; ++i) mean = mean + at((i + 0.5) / 4000) * (1.0 / 4000);
        for (const ExpectedElectronImage& image :
             {by_transform(o, {&arc, 1}, one), directly(o, {&arc, 1}, one)}) {
          const PixelPosition seen = centroid(image);
          EXPECT_NEAR(seen.x_px, mean.x_px, 0.01) << projection.name() << k << turn_deg;
          EXPECT_NEAR(seen.y_px, mean.y_px, 0.01) << projection.name() << k << turn_deg;
        }
      }
    }
}

// Sirius is 1e7 times brighter than a V = 16 object (17.5 magnitudes).
TEST(Blur, ABrightStarLeavesThePhotometryOfAFaintObjectAlone) {
  Threads one(1);
  const Optics o = telescope(200, 160);
  const Arc faint = point(130.4, 90.7, 1e4), bright = point(60.2, 70.9, 1e11);
  const Arc both[] = {bright, faint};
  const ExpectedElectronImage with = directly(o, both, one),
                              without = directly(o, {&bright, 1}, one),
                              alone = directly(o, {&faint, 1}, one);
  double seen = 0, expected = 0;
  for (int y = 80; y <= 101; ++y)
    for (int x = 120; x <= 141; ++x) {
      seen += double(with.at(x, y)) - without.at(x, y);
      expected += alone.at(x, y);
    }
  EXPECT_NEAR(seen / expected, 1.0, 1e-3);
}

TEST(Blur, IsNowhereNegativeBeyondRoundingAndLosesNothing) {
  Threads one(1);
  const Optics o = telescope(300, 260);
  const Arc arcs[] = {point(150.2, 130.1, 1e8), point(100.3, 90.6, 10)};
  const ExpectedElectronImage a = by_transform(o, arcs, one);
  for (float e : a.pixels) ASSERT_GE(e, 0.0f);
  EXPECT_NEAR(sum(a) / (1e8 + 10), 1.0, 1e-6);
  const ExpectedElectronImage b = directly(o, arcs, one);
  const double rounding = 2e-7 * greatest(b);
  for (float e : b.pixels) ASSERT_GE(e, -rounding);
  EXPECT_NEAR(sum(b) / (1e8 + 10), 1.0, 1e-6);
}

TEST(Blur, NothingWrapsAroundAndLightBesideTheFrameReachesIn) {
  Threads one(1);
  const Optics o = telescope(120, 100);
  const Arc corner = point(119.5, 99.5, 1e6), beside = point(121.0, 50.0, 1e6),
            far = point(400.0, 50.0, 1e9);
  const ExpectedElectronImage quarter = by_transform(o, {&corner, 1}, one);
  EXPECT_NEAR(sum(quarter), 2.5e5, 2.5e3);
  for (int y = 0; y < 60; ++y)
    for (int x = 0; x < 60; ++x) ASSERT_LT(quarter.at(x, y), 0.2f);
  for (const ExpectedElectronImage& image :
       {by_transform(o, {&beside, 1}, one), directly(o, {&beside, 1}, one)}) {
    EXPECT_GT(sum(image), 1e4);
    EXPECT_LT(sum(image), 3e5);
  }
  EXPECT_EQ(sum(by_transform(o, {&far, 1}, one)), 0.0);
  EXPECT_EQ(sum(directly(o, {&far, 1}, one)), 0.0);
}

TEST(Blur, PrimeSizesAndSingleRowsHaveTheSamePhotometry) {
  Threads two(2);
  for (auto [columns, rows] : {std::pair{2503, 61}, {61, 3329}, {1, 64}, {64, 1}, {1, 1}}) {
    const Optics o = gaussian(columns, rows, 2.1, 2);
    const int column = columns / 2, row = rows / 2;
    const Arc arc = point(column, row, 1e5);
    const ExpectedElectronImage reference = analytically(o, {&arc, 1}, two);
    EXPECT_NEAR(sum(by_transform(o, {&arc, 1}, two)) / sum(reference), 1.0, 1e-4)
        << columns << " " << rows;
    EXPECT_NEAR(sum(directly(o, {&arc, 1}, two)) / sum(reference), 1.0, 1e-4);
  }
}

TEST(Blur, StreaksOfAnyLengthKeepTheirLight) {
  Threads one(1);
  const Optics o = gaussian(160, 140, 2.1, 2);
  for (double length : {0.0, 1e-9, 0.5, 60.0}) {
    const Arc arc = streak({80.3 - length / 2, 70.2}, {80.3 + length / 2, 70.2}, 1e5);
    for (const ExpectedElectronImage& image :
         {by_transform(o, {&arc, 1}, one), directly(o, {&arc, 1}, one)}) {
      EXPECT_NEAR(sum(image) / 1e5, 1.0, 1e-6) << length;
      EXPECT_NEAR(centroid(image).x_px, 80.3, 0.001) << length;
    }
  }
  const Arc endless = streak({-5e4 + 80, 70.2}, {5e4 + 80, 70.2}, 1e8);
  for (const ExpectedElectronImage& image :
       {by_transform(o, {&endless, 1}, one), directly(o, {&endless, 1}, one)})
    EXPECT_NEAR(sum(image) / (1e8 * 160 / 1e5), 1.0, 1e-3);
  const Arc outside = streak({-300, -300}, {500, -400}, 1e8);
  EXPECT_EQ(sum(by_transform(o, {&outside, 1}, one)), 0.0);
  EXPECT_EQ(sum(directly(o, {&outside, 1}, one)), 0.0);
}

TEST(Blur, TheBytesDoNotDependOnThreads) {
  const Optics o = telescope(257, 199);
  std::vector<Arc> arcs;
  for (int i = 0; i < 60; ++i)
    arcs.push_back(streak({4.1 * i, 3.3 * i}, {4.1 * i + 9, 3.3 * i + 5}, 1e4 + i));
  Threads one(1);
  const ExpectedElectronImage a = by_transform(o, arcs, one), b = directly(o, arcs, one);
  for (int n : {2, 4}) {
    Threads threads(n);
    EXPECT_EQ(by_transform(o, arcs, threads).pixels, a.pixels) << n;
    EXPECT_EQ(directly(o, arcs, threads).pixels, b.pixels) << n;
  }
}

// A field with two kernels: a point half way between their nodes has their mean.
TEST(Blur, KernelsOverTheFieldAreInterpolatedLinearly) {
  Threads one(1);
  const Optics narrow = gaussian(201, 101, 2.0, 2), wide = gaussian(201, 101, 4.0, 2);
  PsfPlan plan = plan_psf(wide, lambda, {}, 1.0);
  const PsfKernel left = kernel_of_camera(narrow, plan), right = kernel_of_camera(wide, plan);
  BlurGrid grid(201, 101, 2, plan.half_cells, 2, 1);
  grid.set_kernels({left, right}, one);
  for (const auto& [x, share] : {std::pair{15.0, 15.0 / 200}, {100.0, 0.5}, {180.0, 0.9}}) {
    const Arc arc = point(x, 50.3, 1e5), on_cells = grid.on_cells(arc);
    grid.clear(one);
    deposit({&on_cells, 1}, make_psf_table(grid_sigma_cells), grid.cells(), one);
    ExpectedElectronImage light(201, 101);
    grid.blur_into(light, PointSpread::Resampling::area, one);
    const ExpectedElectronImage a = analytically(narrow, {&arc, 1}, one),
                                b = analytically(wide, {&arc, 1}, one);
    double deviation = 0;
    for (std::size_t i = 0; i < a.pixels.size(); ++i)
      deviation = std::max(
          deviation, std::abs(light.pixels[i] - (1 - share) * a.pixels[i] - share * b.pixels[i]));
    EXPECT_LT(deviation, 0.01 * greatest(a)) << x;
    EXPECT_NEAR(sum(light) / 1e5, 1.0, 1e-5);
  }
}

}  // namespace
}  // namespace dmise
