#include "core/detection/stars/trail_scan.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "tests/support/simulated_frame.h"
#include "tests/support/simulated_scene.h"

namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;
using simulated::SimulatedScene;

constexpr int size = 300;
constexpr double sky_e = 1500.0;  // noise of 39.8 e- a pixel

/// Stars that trail by 48 px, one of which has its middle beside the frame.
struct Trails {
  std::vector<PixelPosition> places = {{60.4, 70.2}, {200.7, 90.5}, {120.1, 230.9}, {150, -3}};
  double flux_e = 40000.0;
  SimulatedScene exposed = expose();
  ResidualFrame residual{exposed.scene, point_snr(exposed.scene)};
  TrailScan scan{exposed.scene, residual};

  SimulatedScene expose() const {
    const FrameHeader header = camera_header(size, size, 1663, 0.0, 400.0, true);
    SimulatedFrame frame(header, size, size, sky_e, 5);
    for (const PixelPosition& place : places) frame.add_star(place.x_px, place.y_px, flux_e);
    return {header, frame.expose()};
  }
  Trail trail_at(const PixelPosition& place) const {
    Trail trail = exposed.scene.star_trail(place.x_px, place.y_px);
    trail.flux_e = flux_e;
    return trail;
  }
};

TEST(TrailScan, PeaksClimbToTheMiddlesOfTrails) {
  const Trails trails;
  std::vector<bool> seen(trails.places.size());
  for (TrailPlace peak : trails.scan.peaks(8.0)) {
    EXPECT_GE(peak.score, 0.8 * 8.0);
    EXPECT_GT(trails.scan.climb(peak), 0.0);
    for (std::size_t i = 0; i < seen.size(); ++i)
      if (std::hypot(peak.x_px - trails.places[i].x_px, peak.y_px - trails.places[i].y_px) < 3)
        seen[i] = true;
  }
  EXPECT_EQ(std::count(seen.begin(), seen.end(), true), std::ptrdiff_t(seen.size()));
}

TEST(TrailScan, HasNoPeaksOnceTheStarsAreSubtracted) {
  Trails trails;
  for (const PixelPosition& place : trails.places) trails.residual.subtract(trails.trail_at(place));
  for (const TrailPlace& peak : trails.scan.peaks(8.0)) EXPECT_LT(peak.score, 8.0);
}

TEST(TrailScan, PartsOfATrailHaveItsLevel) {
  const Trails trails;
  for (std::size_t i = 0; i < 3; ++i) {
    const Trail trail = trails.trail_at(trails.places[i]);
    const double level = trails.scan.level_of(trail);
    EXPECT_GT(level, 10.0);
    for (const double from_px : {-18.0, -6.0, 6.0}) {
      const TrailScan::Part part = trails.scan.part_of(trail, from_px, from_px + 12);
      EXPECT_EQ(part.samples, 12);
      EXPECT_NEAR(part.mean, level, 4 * part.noise + 0.06 * level) << i << " from " << from_px;
    }
    const TrailScan::Part beyond = trails.scan.part_of(trail, 35, 47);
    EXPECT_NEAR(beyond.mean, 0.0, 4 * beyond.noise) << i;
  }
}

TEST(TrailScan, PartsOutsideTheFrameHaveNoSamples) {
  const Trails trails;
  const Trail trail = trails.trail_at({-200, -200});
  EXPECT_EQ(trails.scan.part_of(trail, -10, 10).samples, 0);
}

}  // namespace
}  // namespace dmise
