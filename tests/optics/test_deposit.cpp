#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/base/numeric/rng.h"
#include "core/base/units.h"
#include "core/optics/blur/deposit.h"
#include "core/optics/projection.h"

namespace dmise {
namespace {

constexpr double fwhm_px = 1.5;

Deposited measured(const ExpectedElectronImage& image) {
  double sum = 0, x = 0, y = 0;
  for (int r = 0; r < image.rows; ++r)
    for (int c = 0; c < image.columns; ++c) {
      const double e = image.at(c, r);
      sum += e, x += e * c, y += e * r;
    }
  return sum > 0 ? Deposited{sum, x / sum, y / sum} : Deposited{};
}

Arc point(double x, double y, double e) { return {{x, y}, {x, y}, {x, y}, e}; }
Arc straight(PixelPosition a, PixelPosition b, double e) { return {a, (a + b) * 0.5, b, e}; }

Deposited draw(const Arc& arc, ExpectedElectronImage& image,
               double sigma = fwhm_px / fwhm_per_sigma) {
  Threads one(1);
  return deposit(std::span(&arc, 1), make_psf_table(sigma), view_of(image), one)[0];
}

// Reference: the Gaussian's integral over the pixel by the C library's erf, the path by Simpson's
// rule.
TEST(Deposit, EveryPixelIsThePathIntegralOfThePixelIntegratedGaussian) {
  for (double sigma : {0.3, 0.637, 1.7}) {
    const Arc arc{{10.2, 14.9}, {18.3, 17.2}, {24.4, 25.8}, 1000.0, 0.6};
    ExpectedElectronImage image(48, 40);
    draw(arc, image, sigma);
    double worst = 0, peak = 0;
    for (int r = 0; r < image.rows; ++r)
      for (int c = 0; c < image.columns; ++c) {
        double expected = 0;
        const int steps = 600;
        const auto cut = [&](double edge) { return 0.5 * std::erf(edge / (sigma * std::sqrt(2))); };
        for (int i = 0; i <= steps; ++i) {
          const double tau = double(i) / steps;
          const double simpson = i == 0 || i == steps ? 1.0 / 3 : i % 2 ? 4.0 / 3 : 2.0 / 3;
          const PixelPosition p = place(arc, tau);
          expected += simpson * (1 + 0.6 * (2 * tau - 1)) *
                      (cut(c + 0.5 - p.x_px) - cut(c - 0.5 - p.x_px)) *
                      (cut(r + 0.5 - p.y_px) - cut(r - 0.5 - p.y_px));
        }
        expected *= 1000.0 / steps;
        worst = std::max(worst, std::abs(expected - image.at(c, r)));
        peak = std::max(peak, expected);
      }
    EXPECT_LT(worst / peak, 2e-6) << sigma;
  }
}

TEST(Deposit, FluxAndCentroidOfAStreakOfAnyLengthAreThoseAskedFor) {
  for (double length : {0.0, 1e-9, 1e-5, 0.5, 3.0, 77.0, 480.0})
    for (double angle : {0.0, 0.3, pi / 4, 2.0}) {
      ExpectedElectronImage image(640, 560);
      const PixelPosition middle{320.31, 279.77},
          half{0.5 * length * std::cos(angle), 0.5 * length * std::sin(angle)};
      const Deposited told = draw(straight(middle - half, middle + half, 5e4), image);
      const Deposited seen = measured(image);
      EXPECT_NEAR(seen.signal_e / 5e4, 1.0, 1e-6);
      EXPECT_NEAR(told.signal_e / 5e4, 1.0, 1e-6);
      EXPECT_NEAR(seen.x_px, middle.x_px, 3e-4) << length;
      EXPECT_NEAR(seen.y_px, middle.y_px, 3e-4) << length;
      EXPECT_NEAR(told.x_px, seen.x_px, 1e-5);
      EXPECT_NEAR(told.y_px, seen.y_px, 1e-5);
    }
}

TEST(Deposit, OnlyWhatFallsInsideIsDeposited) {
  // 1e5 px long and centred: the frame's share of it is its width over the length.
  ExpectedElectronImage image(400, 300);
  const Deposited long_one = draw(straight({-49800.0, 150.2}, {50200.0, 150.2}, 1e6), image);
  EXPECT_NEAR(long_one.signal_e, 1e6 * 400 / 1e5, 4e-3);
  EXPECT_NEAR(measured(image).signal_e, long_one.signal_e, 4e-3);

  ExpectedElectronImage dark(400, 300);
  EXPECT_EQ(draw(point(-40, 20, 1e9), dark).signal_e, 0.0);
  EXPECT_EQ(draw(straight({-50, -10}, {500, -30}, 1e9), dark).signal_e, 0.0);
  EXPECT_EQ(measured(dark).signal_e, 0.0);

  // Centred on the frame's corner: a quarter of it. On an edge: a half.
  ExpectedElectronImage corner(40, 30);
  EXPECT_NEAR(draw(point(-0.5, -0.5, 4e4), corner).signal_e, 1e4, 0.1);
  EXPECT_NEAR(measured(corner).signal_e, 1e4, 0.1);
  ExpectedElectronImage edge(40, 30);
  EXPECT_NEAR(draw(straight({39.5, 10}, {39.5, 20}, 4e4), edge).signal_e, 2e4, 0.1);
}

TEST(Deposit, AStreakOfATrillionPixelsTakesNoLongerThanTheFrameIsWide) {
  ExpectedElectronImage image(400, 300);
  const Deposited d = draw(straight({-1e12, 150.2}, {1e12, 150.2}, 1e14), image);
  EXPECT_NEAR(d.signal_e / (1e14 * 400 / 2e12), 1.0, 1e-3);
}

TEST(Deposit, SmallFramesKeepTheirLight) {
  for (auto [columns, rows] : {std::pair{1, 1}, {1, 50}, {50, 1}, {2503, 3}}) {
    ExpectedElectronImage image(columns, rows);
    const Deposited d = draw(point(0.0, 0.0, 1e4), image);
    EXPECT_NEAR(measured(image).signal_e, d.signal_e, 1e-2);
    EXPECT_GT(d.signal_e, 1e3);
  }
}

// Reference: elementary integrals of a brightness that falls to nothing at 60 % of the exposure.
std::vector<Arc> star_field(int count) {
  std::vector<Arc> arcs;
  const RngKey key = rng_key(1, "sensor", 1, "stars");
  for (int i = 0; i < count; ++i) {
    const auto u = [&](std::uint32_t draw) {
      return uniform_of(rng_word(key, std::uint32_t(i), draw));
    };
    const PixelPosition at{u(0) * 3340 - 7, u(1) * 2520 - 8};
    const PixelPosition step{(0.5 + u(2)) * 1.0, (u(3) - 0.5) * 1.0};
    arcs.push_back({at - step, at, at + step + PixelPosition{0.01, 0.02}, 100 + 1e5 * u(4) * u(4)});
  }
  arcs.push_back(straight({100, 100}, {460, 450}, 1e6));
  return arcs;
}

TEST(Deposit, TheBytesDependOnNeitherThreadsNorInstructionSet) {
  auto arcs = star_field(3000);
  for (std::size_t i = 0; i < arcs.size(); i += 2) arcs[i].may_miss_e = 0.02;
  const PsfTable psf = make_psf_table(fwhm_px / fwhm_per_sigma);
  ExpectedElectronImage reference(3326, 2504, 1000.0f);
  Threads one(1);
  const auto told = deposit(arcs, psf, view_of(reference), one, SimdLevel::sse2);
  for (int count : {1, 2, 4})
    for (SimdLevel level : {SimdLevel::sse2, SimdLevel::avx2, SimdLevel::avx512}) {
      if (level > best_simd_level()) continue;
      Threads threads(count);
      ExpectedElectronImage image(3326, 2504, 1000.0f);
      const auto again = deposit(arcs, psf, view_of(image), threads, level);
      EXPECT_EQ(image.pixels, reference.pixels) << count << name(level);
      for (std::size_t i = 0; i < arcs.size(); ++i) ASSERT_EQ(again[i].x_px, told[i].x_px);
    }
}

// Reference: the light-weighted mean of the projected path, from 4000 directions along it.
TEST(Deposit, CentroidsAgreeWithTheRequestedDirectionsInEveryProjection) {
  for (Projection p : {Projection::gnomonic, Projection::equidistant, Projection::equisolid,
                       Projection::stereographic}) {
    const Optics optics{.projection = p,
                        .focal_length_m = 8.98e-3 / 4,
                        .aperture_m = 0.004,
                        .pixel_pitch_m = 5.4e-6,
                        .columns = 832,
                        .rows = 626};
    // A rotation about an axis off the frame: stars' trails, curved in the image; 0: a point.
    const Vec<CameraFrame> axis = unit(Vec<CameraFrame>{0.1, -1.2, 0.4});
    for (double turn_deg : {0.0, 0.3, 5.0}) {
      const auto direction = [&](double tau) {
        const Vec<CameraFrame> v = unit(Vec<CameraFrame>{0.21, 0.17, 1.0});
        const double a = (tau - 0.5) * turn_deg * deg;
        return v * std::cos(a) + cross(axis, v) * std::sin(a) +
               axis * (dot(axis, v) * (1 - std::cos(a)));
      };
      const auto at = [&](double tau) { return *project(optics, direction(tau)); };
      ExpectedElectronImage image(832, 626);
      draw({at(0), at(0.5), at(1), 1e5}, image);
      PixelPosition mean;
      for (int i = 0; i < 4000; ++i) mean = mean + at((i + 0.5) / 4000) * (1.0 / 4000);
      EXPECT_NEAR(measured(image).x_px, mean.x_px, 0.01) << p.name() << turn_deg;
      EXPECT_NEAR(measured(image).y_px, mean.y_px, 0.01) << p.name() << turn_deg;
    }
  }
}

TEST(Deposit, AnArcThatIsNotANumberIsNamed) {
  ExpectedElectronImage image(10, 10);
  EXPECT_THROW(draw(point(std::numeric_limits<double>::quiet_NaN(), 1, 1), image), Error);
  EXPECT_THROW(draw(point(1, 1, -1), image), Error);
}

Arc across(double length, double signal_e, double may_miss_e) {
  Arc arc{{20.3, 20.8}, {}, {20.3 + 0.8 * length, 20.8 + 0.6 * length}, signal_e};
  arc.middle = (arc.start + arc.end) * 0.5;
  arc.may_miss_e = may_miss_e;
  return arc;
}

// An arc that may miss a little is one panel of few nodes, and misses less: beside the sum of
// panels of two widths.
TEST(Deposit, AShortArcMissesNoMoreThanItMay) {
  int differ = 0;
  for (const double sigma : {0.1, 0.2, 0.3, 0.4, 0.5, 0.637, 0.7, 1.2, 2.5})
    for (const double widths : {0.1, 0.5, 1.5, 2.2, 3.0, 3.9, 6.0, 9.0})
      for (const double signal_e : {10.0, 300.0, 3e3, 1e5, 1e6}) {
        ExpectedElectronImage exact(64, 64), rough(64, 64);
        draw(across(widths * sigma, signal_e, 0.0), exact, sigma);
        const Deposited all = draw(across(widths * sigma, signal_e, 0.05), rough, sigma);
        double worst = 0.0;
        for (std::size_t i = 0; i < exact.pixels.size(); ++i)
          worst = std::max(worst, double(std::abs(exact.pixels[i] - rough.pixels[i])));
        EXPECT_LE(worst, 0.05 + 4e-6 * signal_e) << sigma << " " << widths << " " << signal_e;
        EXPECT_NEAR(measured(rough).signal_e, measured(exact).signal_e, 1e-6 * signal_e);
        EXPECT_NEAR(all.signal_e, signal_e, 2e-6 * signal_e);
        differ += exact.pixels != rough.pixels;
      }
  EXPECT_GT(differ, 30);
}

// Across the bands of rows and beside the rim of the frame, where other kernels take over.
TEST(Deposit, AShortArcMissesNoMoreThanItMayAnywhere) {
  std::vector<Arc> arcs;
  for (double y = -6.37; y < 142; y += 1.171)
    for (double x = -6.2; x < 71; x += 2.9173)
      arcs.push_back({{x, y}, {x + 0.8, y - 0.6}, {x + 1.7, y - 1.1}, 300.0, 0.0, 0.02});
  ExpectedElectronImage exact(64, 136), rough(64, 136);
  Threads one(1);
  const PsfTable psf = make_psf_table(fwhm_px / fwhm_per_sigma);
  deposit(arcs, psf, view_of(rough), one);
  for (Arc& arc : arcs) arc.may_miss_e = 0.0;
  deposit(arcs, psf, view_of(exact), one);
  EXPECT_NE(exact.pixels, rough.pixels);
  // Some six arcs share a pixel.
  for (std::size_t i = 0; i < exact.pixels.size(); ++i)
    ASSERT_NEAR(rough.pixels[i], exact.pixels[i], 0.1) << i;
}

// What is told of arcs changes no pixel; what is cut by the rim is told as by all sums.
TEST(Deposit, SumsOfCutArcsAloneAreTheSame) {
  std::vector<Arc> arcs = star_field(4000);
  for (std::size_t i = 0; i < arcs.size(); i += 2) arcs[i].may_miss_e = 0.02;
  const PsfTable psf = make_psf_table(fwhm_px / fwhm_per_sigma);
  ExpectedElectronImage all(3326, 2504), cut(3326, 2504);
  Threads one(1);
  const auto of_all = deposit(arcs, psf, view_of(all), one);
  const auto of_cut = deposit(arcs, psf, view_of(cut), one, best_simd_level(), DepositSums::cut);
  EXPECT_EQ(all.pixels, cut.pixels);
  int at_the_rim = 0;
  for (std::size_t i = 0; i < arcs.size(); ++i) {
    EXPECT_NEAR(of_cut[i].signal_e, of_all[i].signal_e, 2e-6 * arcs[i].signal_e);
    EXPECT_NEAR(of_cut[i].x_px, of_all[i].x_px, 0.02);
    EXPECT_NEAR(of_cut[i].y_px, of_all[i].y_px, 0.02);
    at_the_rim += of_all[i].signal_e < 0.99 * arcs[i].signal_e;
  }
  EXPECT_GT(at_the_rim, 5);
}

// Arcs in one band of rows and in several, within the frame and beyond each edge: what is returned
// is what was drawn.
TEST(Deposit, ReturnsWhatIsInTheFrameAcrossBandsAndEdges) {
  for (const double y : {-1.0, 5.0, 126.0, 128.0, 200.0, 298.5})
    for (const double x : {-2.0, 10.0, 39.5})
      for (const double length : {0.0, 1.0, 30.0, 400.0}) {
        ExpectedElectronImage image(40, 300);
        const Deposited d = draw(straight({x, y}, {x + 1, y + length}, 1000.0), image);
        const Deposited there = measured(image);
        EXPECT_NEAR(d.signal_e, there.signal_e, 0.01);
        if (d.signal_e < 1.0) continue;
        EXPECT_NEAR(d.x_px, there.x_px, 1e-4);
        EXPECT_NEAR(d.y_px, there.y_px, 1e-3);
      }
}

}  // namespace
}  // namespace dmise
