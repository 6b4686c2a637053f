#include "core/optics/snapshots.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/parallel.h"

namespace dmise {
namespace {

RateImage drawn(const std::vector<Arc>& arcs, const PsfTable& psf) {
  RateImage image(96, 48);
  Threads one;
  deposit(arcs, psf, image, one);
  return image;
}

/// Light that lies in other pixels than the path integral puts it, as a share of all.
double misplaced(const RateImage& a, const RateImage& b) {
  double difference = 0, all = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    difference += std::abs(double(a.pixels[i]) - double(b.pixels[i]));
    all += a.pixels[i];
  }
  return difference / all / 2;
}

// A curved streak of 60 px that brightens.
const Arc streak{{15, 12}, {46, 20}, {76, 36}, 1e5, 0.4};

TEST(Snapshots, ConvergeToThePathIntegralAtLeastAsOneOverTheirNumber) {
  const PsfTable psf = make_psf_table(0.8);
  const RateImage exact = drawn({streak}, psf);
  double last = 1.0;
  for (int count = 4; count <= 1024; count *= 2) {
    const double error = misplaced(exact, drawn(as_snapshots({&streak, 1}, count), psf));
    EXPECT_LT(error, 1.1 * 60.0 / count) << count;  // never worse than half the way between two
    if (count >= 16) {
      EXPECT_LT(error, 0.55 * last) << count;
    }
    last = error;
  }
  EXPECT_LT(last, 2e-3);
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
