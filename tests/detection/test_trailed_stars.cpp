#include "core/detection/stars/trailed_stars.h"

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

#include "core/base/units.h"
#include "core/detection/detect.h"
#include "core/detection/stars/psf_measure.h"
#include "tests/support/simulated_frame.h"
#include "tests/support/simulated_scene.h"

namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;
using simulated::SimulatedScene;

constexpr int size = 512;
constexpr double sky_e = 1500.0;  // noise of 39.8 e- a pixel
constexpr double exposure_s = 400.0, focal_px = 1663.0;

/// A frame of stars that trail by 48 px, and points that do not.
struct Trails {
  FrameHeader header;
  std::vector<PixelPosition> stars, points;
  CountImage counts;

  explicit Trails(int star_count, int point_count = 0)
      : header(camera_header(size, size, focal_px, 0.0, exposure_s, true)) {
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

  std::vector<TrailedStar> found() const {
    return find_trailed_stars(SimulatedScene(header, counts).scene);
  }
};

bool is_near(const PixelPosition& a, const PixelPosition& b, double px) {
  return std::hypot(a.x_px - b.x_px, a.y_px - b.y_px) < px;
}

TEST(TrailedStars, AreFoundWithoutACatalogue) {
  const Trails trails(60);
  const auto found = trails.found();
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

// Widths are those that the simulation draws.
TEST(TrailedStars, MeasureThePsfWhereTheHeaderIsWrong) {
  Trails trails(60);
  const double drawn_px = trails.header.psf_fwhm_px;
  trails.header.psf_fwhm_px = 1.5 * drawn_px;
  const SimulatedScene simulated(trails.header, trails.counts);
  std::vector<Trail> found;
  for (const TrailedStar& star : find_trailed_stars(simulated.scene)) found.push_back(star.trail);
  const PsfField psf = measure_psf_of_trails(simulated.scene, found);
  EXPECT_GE(psf.stars, 20);
  EXPECT_NEAR(fwhm_per_sigma * psf.width_px, drawn_px, 0.05 * drawn_px);
}

TEST(TrailedStars, MeasureNoPsfWhereFew) {
  const Trails trails(5);
  const SimulatedScene simulated(trails.header, trails.counts);
  std::vector<Trail> found;
  for (const TrailedStar& star : find_trailed_stars(simulated.scene)) found.push_back(star.trail);
  EXPECT_EQ(measure_psf_of_trails(simulated.scene, found).stars, 0);
}

TEST(TrailedStars, LeavePointsToBeFoundUnderAnyMount) {
  for (const char* mount : {"unknown", "fixed"}) {
    Trails trails(60, 25);
    trails.header.mount = mount;
    Threads one;
    const DetectionResult result = detect(trails.counts, trails.header, nullptr, one);
    int seen = 0, others = 0;
    for (const Detection& d : result.detections) {
      bool is_point = false;
      for (const PixelPosition& p : trails.points) is_point |= is_near(p, {d.x_px, d.y_px}, 1.0);
      (is_point ? seen : others) += 1;
    }
    EXPECT_GE(seen, 22) << mount;  // some lie on bright trails
    EXPECT_EQ(others, 0) << mount;
  }
}

// What stars leave that are too faint to be subtracted does not hide a bright point.
TEST(TrailedStars, LeavePointsBesideFaintOnes) {
  FrameHeader header = camera_header(size, size, focal_px, 0.0, exposure_s, true);
  header.mount = "unknown";
  int seen = 0, others = 0;
  for (const unsigned seed : {41U, 42U}) {
    SimulatedFrame frame(header, size, size, sky_e, seed);
    for (int i = 0; i < 60; ++i)
      frame.add_star(frame.uniform(0, size), frame.uniform(0, size),
                     8000 * std::pow(12.0, frame.uniform(0, 1)));
    std::vector<PixelPosition> points;
    for (int i = 0; i < 20; ++i) {
      points.push_back({60.0 + 97 * (i % 5) + frame.uniform(-10, 10),
                        60.0 + 97 * double(i / 5) + frame.uniform(-10, 10)});
      frame.add_point(points.back().x_px, points.back().y_px, 6000);                  // SNR 50
      frame.add_star(points.back().x_px + 2, points.back().y_px + 24 + i % 3, 3500);  // SNR 5
    }
    Threads one;
    for (const Detection& d : detect(frame.expose(), header, nullptr, one).detections) {
      bool is_point = false;
      for (const PixelPosition& p : points) is_point |= is_near(p, {d.x_px, d.y_px}, 1.0);
      (is_point ? seen : others) += 1;
    }
  }
  EXPECT_GE(seen, 36);  // some lie on bright trails
  EXPECT_EQ(others, 0);
}

/// Detections in a frame of groups of stars. Each has `count` on a line along the trails, of which
/// the distances are `apart` lengths of a trail, with light that falls to a half from one to the
/// next.
std::size_t found_in_groups(int count, double apart) {
  const FrameHeader header = camera_header(size, size, focal_px, 0.0, exposure_s, true);
  SimulatedFrame frame(header, size, size, sky_e, 7);
  const SimulatedScene empty(header, CountImage(size, size));
  for (int row = 0; row < 10; ++row)
    for (int column = 0; column < 2; ++column) {
      const PixelPosition first{100.0 + 230 * column + frame.uniform(-20, 20),
                                40.0 + 46 * row + frame.uniform(-5, 5)};
      const Trail trail = empty.scene.star_trail(first.x_px, first.y_px);
      double flux_e = 30000;
      for (int k = 0; k < count; ++k, flux_e *= 0.5) {
        const PixelPosition at = trail.at(k * apart * trail.length_px);
        frame.add_star(at.x_px, at.y_px, flux_e);
      }
    }
  Threads one;
  return detect(frame.expose(), header, nullptr, one).detections.size();
}

TEST(TrailedStars, ThatOverlapLeaveNoPoints) {
  for (const double apart : {0.03, 0.06, 0.12, 0.5})
    EXPECT_EQ(found_in_groups(2, apart), 0u) << apart;
}

TEST(TrailedStars, InRowsAreNoStreaks) {
  for (const double apart : {0.9, 1.0, 1.1}) EXPECT_EQ(found_in_groups(3, apart), 0u) << apart;
}

// The bound of the search is in reads of pixels: it does not depend on the machine.
TEST(TrailedStars, AreLeftWhereTheyAreTooManyToFindInBoundedTime) {
  const Trails trails(6000);
  EXPECT_TRUE(trails.found().empty());
}

}  // namespace
}  // namespace dmise
