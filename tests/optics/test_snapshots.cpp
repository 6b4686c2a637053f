#include "core/optics/blur/snapshots.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/units.h"

namespace dmise {
namespace {

ExpectedElectronImage drawn(const std::vector<Arc>& arcs, const PsfTable& psf) {
  ExpectedElectronImage image(96, 48);
  Threads one;
  deposit(arcs, psf, view_of(image), one);
  return image;
}

/// Light that lies in other pixels than the path integral puts it, as a share of all.
double misplaced(const ExpectedElectronImage& a, const ExpectedElectronImage& b) {
  double difference = 0, all = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    difference += std::abs(double(a.pixels[i]) - double(b.pixels[i]));
    all += a.pixels[i];
  }
  return difference / all / 2;
}

// A curved streak of 60 px that brightens.
const Arc streak{{15, 12}, {46, 20}, {76, 36}, 1e5, 0.4};

// A Gaussian of deviation sigma that is moved by s misplaces erf(s / (sigma sqrt 8)) of its light,
// at most s / (sigma sqrt(2 pi)); a snapshot moves light by v / 4N in the mean, v being the speed
// of the path in pixels an exposure. Pixels and the sum of all snapshots make it no more.
TEST(Snapshots, ConvergeToThePathIntegralAtLeastAsOneOverTheirNumber) {
  const auto speed = [](double a, double b, double c, double d) {
    return std::hypot(b - a, d - c);
  };
  const double fastest_px =
      1.01 * std::max(speed(3 * streak.start.x_px + streak.end.x_px, 4 * streak.middle.x_px,
                            3 * streak.start.y_px + streak.end.y_px, 4 * streak.middle.y_px),
                      speed(4 * streak.middle.x_px, streak.start.x_px + 3 * streak.end.x_px,
                            4 * streak.middle.y_px, streak.start.y_px + 3 * streak.end.y_px));
  for (const double sigma_px : {0.34, 0.8, 1.7, 4.0}) {
    const PsfTable psf = make_psf_table(sigma_px);
    const ExpectedElectronImage exact = drawn({streak}, psf);
    const double bound = fastest_px / (4 * sigma_px * std::sqrt(2 * pi));
    for (int count = 1; count <= 1024; count += 1 + count / 32) {
      const double error = misplaced(exact, drawn(as_snapshots({&streak, 1}, count), psf));
      EXPECT_LE(error, bound / count) << sigma_px << " " << count;
      // Closer than the blur they are even, and what is left falls as 1/N^2.
      if (fastest_px / count < sigma_px) {
        EXPECT_LE(error, 8 * bound / (double(count) * count)) << sigma_px << " " << count;
      }
    }
  }
}

TEST(Snapshots, KeepTheLightAndTheMiddle) {
  for (const int count : {1, 2, 7, 100}) {
    double light = 0, x = 0;
    for (const auto& point : as_snapshots({&streak, 1}, count)) {
      light += point.signal_e;
      x += point.signal_e * point.middle.x_px;
    }
    EXPECT_NEAR(light, 1e5, 1e-6);
    if (count >= 100) {
      EXPECT_NEAR(x / light, 50.0, 1.0);
    }
  }
}

TEST(Snapshots, OfSeveralArcsFollowOneAnother) {
  const std::vector<Arc> path{{{0, 0}, {5, 0}, {10, 0}, 10, 0},
                              {{10, 0}, {10, 5}, {10, 10}, 30, 0}};
  const auto points = as_snapshots(path, 4);
  ASSERT_EQ(points.size(), 4u);
  EXPECT_NEAR(points[1].middle.x_px, 7.5, 1e-12);
  EXPECT_NEAR(points[2].middle.y_px, 2.5, 1e-12);
  EXPECT_NEAR(points[0].signal_e, 5, 1e-12);
  EXPECT_NEAR(points[3].signal_e, 15, 1e-12);
  EXPECT_TRUE(as_snapshots({}, 4).empty());
}

}  // namespace
}  // namespace dmise
