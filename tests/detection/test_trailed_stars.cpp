#include "core/detection/trailed_stars.h"

#include <gtest/gtest.h>

#include <cmath>
#include <optional>
#include <vector>

#include "core/detection/common_trail.h"
#include "core/detection/detect.h"
#include "tests/support/simulated_frame.h"

namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;

constexpr int size = 512;
constexpr double sky_e = 1500.0;  // noise of 39.8 e- a pixel
constexpr double exposure_s = 400.0, focal_px = 1663.0;

/// A frame of stars that trail by 48 px, and points that do not.
struct Trails {
  FrameHeader header;
  std::vector<PixelPosition> stars, points;
  CountImage counts;

  explicit Trails(int star_count, bool at_rest = true, int point_count = 0)
      : header(camera_header(size, size, focal_px, 0.0, exposure_s, at_rest)) {
    SimulatedFrame frame(header, size, size, sky_e, 5);
    for (int i = 0; i < star_count; ++i) {
      const PixelPosition at{frame.uniform(0, size), frame.uniform(0, size)};
      frame.add_star(at.x_px, at.y_px, 8000 * std::pow(12.0, frame.uniform(0, 1)));
      stars.push_back(at);
    }
    for (int i = 0; i < point_count; ++i) {
      points.push_back({60.0 + 97 * (i % 5) + frame.uniform(-20, 20),
                        60.0 + 97 * double(i / 5) + frame.uniform(-20, 20)});
      frame.add_point(points.back().x_px, points.back().y_px, 2400);  // SNR 20
    }
    counts = frame.expose();
  }

  template <class Question>
  auto ask(const Question& question) const {
    Threads one;
    const Background background(counts, 64, one);
    const StarMotion motion(header, size, size);
    const Scene scene{counts,  background,
                      motion,  header.gain_e_per_dn,
                      63000.0, sigma_with_pixel(header.psf_fwhm_px),
                      false,   PsfField::gaussian(header.psf_fwhm_px)};
    return question(scene);
  }
};

bool is_near(const PixelPosition& a, const PixelPosition& b, double px) {
  return std::hypot(a.x_px - b.x_px, a.y_px - b.y_px) < px;
}

TEST(TrailedStars, AreFoundWithoutACatalogue) {
  const Trails trails(60);
  const auto found = trails.ask([](const Scene& scene) { return find_trailed_stars(scene); });
  int seen = 0;
  for (const PixelPosition& star : trails.stars)
    for (const TrailedStar& f : found)
      if (is_near(star, {f.trail.x_px, f.trail.y_px}, 1.0)) {
        ++seen;
        break;
      }
  EXPECT_GE(seen, 57);  // some lie on others
  EXPECT_LE(found.size(), trails.stars.size() + 2);
}

TEST(TrailedStars, LeavePointsToBeFound) {
  Trails trails(60, true, 25);
  trails.header.mount = "unknown";
  Threads one;
  const DetectionResult result = detect(trails.counts, trails.header, nullptr, one);
  int seen = 0, others = 0;
  for (const Detection& d : result.detections) {
    bool is_point = false;
    for (const PixelPosition& p : trails.points) is_point |= is_near(p, {d.x_px, d.y_px}, 1.0);
    (is_point ? seen : others) += 1;
  }
  EXPECT_GE(seen, 22);  // some lie on bright trails
  EXPECT_EQ(others, 0);
}

// The bound of the search is in reads of pixels: it does not depend on the machine.
TEST(TrailedStars, AreLeftWhereTheyAreTooManyToFindInBoundedTime) {
  const Trails trails(6000);
  EXPECT_TRUE(trails.ask([](const Scene& scene) { return find_trailed_stars(scene); }).empty());
}

TEST(CommonTrail, IsMeasuredWhereTrailsOverlap) {
  const Trails trails(200);
  const auto common = trails.ask([](const Scene& scene) { return common_trail(scene); });
  ASSERT_TRUE(common);
  const PixelPosition true_px =
      StarMotion(trails.header, size, size).trail_at({size / 2.0, size / 2.0});
  const double sign = common->y_px * true_px.y_px + common->x_px * true_px.x_px < 0 ? -1 : 1;
  EXPECT_NEAR(sign * common->x_px, true_px.x_px, 0.4);
  EXPECT_NEAR(sign * common->y_px, true_px.y_px, 0.4);
}

TEST(CommonTrail, IsNotThereWhereStarsArePoints) {
  const Trails points(200, false);
  EXPECT_FALSE(points.ask([](const Scene& scene) { return common_trail(scene); }));
}

}  // namespace
}  // namespace dmise
