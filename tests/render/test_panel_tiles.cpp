#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "tests/render/scenes.h"

namespace dmise {
namespace {

struct Turning {
  std::string name;
  Mesh mesh;
  HingedPanel panel;
};

std::vector<Turning> turning() {
  return {
      {"box-wing", box_wing({}, named("kapton"), named("silicon-cell"), named("white-paint")),
       HingedPanel{{}, {0, 0, 0.5}}},
      {"starlink",
       starlink_like(named("starlink-chassis"), named("starlink-array"), named("starlink-array")),
       starlink_like_panel()}};
}

// As of shapes that do not turn: 0.5 %, or 5e-6 of the brightest view.
TEST(PanelTile, SumOfThePixelsIsTheUnresolvedFluxAtEveryAngle) {
  const auto directions = even_directions<Body>(60);
  for (const auto& [name, mesh, panel] : turning()) {
    const FacetLight at_rest(mesh, Band{});
    const TileCamera camera = camera_around(radius_m(mesh, panel), far_m, 96);
    std::vector<double> got, expected;
    for (std::size_t i = 0; i < 60; ++i) {
      const Vec<Body> sun = directions[i], viewer = directions[(7 * i + 31) % 60];
      const FacetLight object = at_rest.turned(panel, sun);
      expected.push_back(sun_photons * object.reflected_m2_per_sr(sun, viewer) / (far_m * far_m));
      got.push_back(flux(draw(object, sun, viewer, camera, 0.7 * double(i), 16), camera));
    }
    const double brightest = *std::ranges::max_element(expected);
    for (std::size_t i = 0; i < got.size(); ++i)
      EXPECT_NEAR(got[i], expected[i], std::max(5e-3 * expected[i], 5e-6 * brightest))
          << name << ", geometry " << i;
  }
}

// From the Sun, wings of 20 m2 cover what their hinge lets them turn to it.
TEST(PanelTile, ShowsTheAreaThatFacesTheSun) {
  const Mesh mesh = box_wing({.body_m = {1e-3, 1e-3, 1e-3}, .wing_length_m = 5, .wing_width_m = 2},
                             named("kapton"), named("silicon-cell"), named("white-paint"));
  const FacetLight at_rest(mesh, Band{});
  const TileCamera camera = camera_around(radius_m(mesh), far_m, 128);
  for (const auto& sun : even_directions<Body>(20)) {
    const Tile tile = draw(at_rest.turned({}, sun), sun, sun, camera, 0.3, 16);
    double covered_m2 = 0;
    for (const float share : tile.coverage) covered_m2 += share;
    covered_m2 *= far_m * far_m / (camera.focal_px * camera.focal_px);
    EXPECT_NEAR(covered_m2, 20.0 * std::hypot(sun.x, sun.z), 0.1) << sun.y;
  }
}

}  // namespace
}  // namespace dmise
