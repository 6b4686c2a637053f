#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/units.h"
#include "sensors/render/resolution.h"
#include "tests/render/scenes.h"

// Rows of "Geometry and light" of the list of hard cases that concern objects with a shape.
namespace dmise {
namespace {

const Vec<Body> towards{0, 0, 1};

TEST(HardGeometry, APlatformOf1mAt36000kmIsUnresolved) {
  EXPECT_FALSE(is_resolved(1.0, 36e6, 0.5 * arcsec, 0.05));
  EXPECT_TRUE(is_resolved(1.0, 10e3, 0.5 * arcsec, 0.05));
  // The error of a point in the middle: a shape of that radius moves and widens by no more.
  EXPECT_TRUE(is_resolved(0.06, 1e5, 1e-6 / 1.0, 0.5));
}

TEST(HardGeometry, APlatformThatFillsTheFrameCoversEveryPixel) {
  const Mesh mesh = plate(100, 100, named("white-paint"), named("white-paint"));
  const FacetLight object(mesh, Band{});
  const TileCamera frame{
      .focal_px = 64, .principal_x_px = 31.5, .principal_y_px = 31.5, .columns = 64, .rows = 64};
  const TileCamera tile_camera = tile_around(mesh, looking_along(-towards, 0.4), {0, 0, 10}, frame);
  EXPECT_EQ(tile_camera.columns, 64);
  EXPECT_EQ(tile_camera.rows, 64);
  const Tile tile = draw(object, towards, towards, tile_camera, 0.4, 4, 10.0);
  for (const float c : tile.coverage) EXPECT_EQ(c, 1.0f);
  for (const float r : tile.radiance)
    EXPECT_NEAR(r / (sun_photons * 0.8 / pi), 1.0, 1e-5);  // Lambert: the same everywhere
}

// The camera sees what is near of a plate of 100 km, before it and beside it.
TEST(HardGeometry, ALargePlatformIsSeenFromNearby) {
  const Mesh mesh = plate(1e5, 1e5, named("white-paint"), named("white-paint"));
  const FacetLight object(mesh, Band{});
  const TileCamera camera{
      .focal_px = 32, .principal_x_px = 31.5, .principal_y_px = 31.5, .columns = 64, .rows = 64};
  for (const double range_m : {1e3, 50.0, 0.1})
    for (const double tilt : {0.0, 0.3}) {
      const auto camera_from_body = looking_along({std::sin(tilt), 0, -std::cos(tilt)}, 0.4);
      const Tile tile = renderer().draw({.mesh = &mesh,
                                         .bands = {{&object.facets(), sun_photons}},
                                         .camera_from_body = camera_from_body,
                                         .object_m = camera_from_body * (towards * -range_m),
                                         .sources = {{towards, 1.0}},
                                         .camera = camera});
      for (const float c : tile.coverage) ASSERT_EQ(c, 1.0f) << range_m << " m, " << tilt;
      for (const float r : tile.radiance) ASSERT_NEAR(r / (sun_photons * 0.8 / pi), 1.0, 1e-5);
    }
}

TEST(HardGeometry, ACameraInTheBoundingBoxIsAClearError) {
  const FacetLight object(box_wing({}, named("kapton"), named("kapton"), named("kapton")), Band{});
  try {
    draw(object, towards, towards, camera_around(1, 10, 16), 0, 1, 0.2);
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(), "camera is inside the object's bounding box");
  }
}

TEST(HardGeometry, OneMetreAndFortyThousandKilometresAreBothResolvedInDepth) {
  const Mesh mesh = box_wing({}, named("kapton"), named("silicon-cell"), named("white-paint"));
  const FacetLight object(mesh, Band{});
  const Vec<Body> sun = unit(Vec<Body>{0.5, 0.2, 1}), viewer = unit(Vec<Body>{-0.3, 0.9, 0.4});
  double light[2];
  int k = 0;
  for (const double range_m : {4e4, 4e7}) {
    const TileCamera camera = camera_around(radius_m(mesh), range_m, 64);
    light[k++] = flux(draw(object, sun, viewer, camera, 0.1, 16, range_m), camera) * range_m *
                 range_m / (sun_photons * object.reflected_m2_per_sr(sun, viewer));
  }
  EXPECT_NEAR(light[0], 1.0, 5e-3);
  EXPECT_NEAR(light[1], 1.0, 5e-3);  // hidden parts stay hidden: depth within 12 m of 40,000 km
  const Mesh metre = plate(1, 1, named("white-paint"), named("white-paint"));
  const FacetLight near_plate(metre, Band{});
  const TileCamera wide{
      .focal_px = 32, .principal_x_px = 31.5, .principal_y_px = 31.5, .columns = 64, .rows = 64};
  const Tile tile = draw(near_plate, towards, towards, wide, 0, 8, 1.0);
  double covered = 0;
  for (const float c : tile.coverage) covered += c;
  EXPECT_NEAR(covered, 32.0 * 32.0, 1.0);
}

// A plate of 2 m x 200 m that passes the camera 1 m below it, from before to behind: in the picture
// it is |x| <= y (its edges recede to the horizon), below the horizon only.
TEST(HardGeometry, AnObjectThatCrossesTheImagePlaneIsNotWrapped) {
  const Mesh mesh = plate(2, 200, named("white-paint"), named("white-paint"));
  const FacetLight object(mesh, Band{});
  // Camera axes: z forward along the body's y, y down along -z.
  const Rotation<CameraFrame, Body> camera_from_body{{{{1, 0, 0}, {0, 0, -1}, {0, 1, 0}}}};
  const TileCamera frame{
      .focal_px = 50, .principal_x_px = 49.5, .principal_y_px = 49.5, .columns = 100, .rows = 100};
  const TileCamera camera = tile_around(mesh, camera_from_body, {0, 1, 0}, frame);
  EXPECT_EQ(camera.columns, 100);
  const Tile tile = renderer().draw({.mesh = &mesh,
                                     .bands = {{&object.facets(), sun_photons}},
                                     .camera_from_body = camera_from_body,
                                     .object_m = {0, 1, 0},
                                     .sources = {{{0, 0, 1}, 1.0}},
                                     .camera = camera});
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x) {
      const double u = std::abs(x - 49.5), v = y - 49.5;
      const float covered = tile.coverage[std::size_t(y) * 100 + std::size_t(x)];
      if (v < 0 || u > v + 1) {
        EXPECT_EQ(covered, 0.0f) << x << " " << y;
      }
      if (v > 1.5 && u < v - 1) {
        EXPECT_EQ(covered, 1.0f) << x << " " << y;
      }
    }
}

TEST(HardGeometry, AnObjectBehindTheCameraHasNoPixels) {
  const Mesh mesh = box({1, 1, 1}, named("white-paint"));
  const TileCamera tile = tile_around(mesh, {}, {0, 0, -10}, camera_around(1, 10, 64));
  EXPECT_EQ(tile.columns, 0);
  const TileCamera aside = tile_around(mesh, {}, {100, 0, 10}, camera_around(1, 10, 64));
  EXPECT_EQ(aside.columns, 0);
}

TEST(HardGeometry, Phase180IsDarkAndPhase0Finite) {
  for (const auto& [shape, mesh] : shipped_shapes()) {
    const FacetLight object(mesh, Band{});
    const Vec<Body> viewer = unit(Vec<Body>{0.3, -0.5, 0.8});
    const TileCamera camera = camera_around(radius_m(mesh), far_m, 32);
    double dark = 0;
    for (const float r : draw(object, -viewer, viewer, camera, 0.2, 4).radiance) dark += r;
    EXPECT_LT(dark, 1e-2) << shape;  // its warmth in V, photons/s/m2/sr; lit it has some 1e20
    for (const float r : draw(object, viewer, viewer, camera, 0.2, 4).radiance)
      ASSERT_TRUE(std::isfinite(r) && r >= 0) << shape;
  }
}

TEST(HardGeometry, GrazingLightGrazingViewAndEdgesStayFinite) {
  const Mesh mesh = box({1, 2, 3}, sandford_robertson_of("m", {{1e-6}, {0.9}}, 0.1, 0.3, 0.01));
  const FacetLight object(mesh, Band{});
  const TileCamera camera = camera_around(radius_m(mesh), far_m, 32);
  for (const double angle : {0.0, 1e-12, 1e-6, 1e-3})
    for (const double other : {0.0, 1e-9, 0.4}) {
      const Vec<Body> sun = unit(Vec<Body>{1, angle, other}),
                      viewer = unit(Vec<Body>{1, other, angle});
      const Tile tile = draw(object, sun, viewer, camera, 0.0, 4);
      for (const float r : tile.radiance) ASSERT_TRUE(std::isfinite(r) && r >= 0);
    }
}

TEST(HardGeometry, LightFollowsThePenumbraInProportion) {
  const FacetLight object(box({1, 1, 1}, named("white-paint")), Band{});
  const TileCamera camera = camera_around(1.0, far_m, 16);
  double last = -1;
  for (const double sunlit : {0.0, 0.1, 0.5, 0.9, 1.0}) {
    const Tile tile = renderer().draw({.mesh = &object.mesh(),
                                       .bands = {{&object.facets(), sun_photons * sunlit}},
                                       .camera_from_body = looking_along(-towards, 0),
                                       .object_m = {0, 0, far_m},
                                       .sources = {{towards, 1.0}},
                                       .camera = camera});
    EXPECT_NEAR(tile.at(8, 8, 0), sunlit * sun_photons * 0.8 / pi, 1e-5 * sun_photons);
    EXPECT_GT(tile.at(8, 8, 0), last);
    last = tile.at(8, 8, 0);
  }
}

TEST(HardGeometry, TilesOfNoSizeAndScenesWithoutLightAreErrors) {
  const FacetLight object(box({1, 1, 1}, named("white-paint")), Band{});
  EXPECT_THROW(draw(object, towards, towards, camera_around(1, far_m, 0), 0, 4), Error);
  EXPECT_THROW(draw(object, towards, towards, camera_around(1, far_m, 20000), 0, 4), Error);
  EXPECT_THROW(draw(object, towards, towards, camera_around(1, far_m, 16), 0, 0), Error);
}

}  // namespace
}  // namespace dmise
