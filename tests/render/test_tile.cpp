#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "tests/render/scenes.h"

namespace dmise {
namespace {

TEST(Renderer, SaysWhatDraws) {
  const std::string text = renderer().description();
  EXPECT_TRUE(text.find("OSMesa, ") == 0 || text.find("EGL, ") == 0) << text;
}

// 64 pixels across, 16 x 16 samples each. Below a thousandth of an object's brightest view the
// light comes from edges thinner than a sample: there 5e-6 of that view may be missing or too much.
TEST(Tile, SumOfThePixelsIsTheUnresolvedFluxOfEveryShape) {
  const auto directions = even_directions<Body>(200);
  for (const auto& [shape, mesh] : shipped_shapes()) {
    const FacetLight object(mesh, Band{});
    const TileCamera camera = camera_around(radius_m(mesh), far_m, 64);
    std::vector<double> got, expected;
    for (int i = 0; i < 200; ++i) {
      const Vec<Body> sun = directions[std::size_t(i)];
      const Vec<Body> viewer = directions[std::size_t((i * 77 + 31) % 200)];
      expected.push_back(sun_photons * object.reflected_m2_per_sr(sun, viewer) / (far_m * far_m));
      got.push_back(flux(draw(object, sun, viewer, camera, 0.7 * i, 16), camera));
    }
    const double brightest = *std::max_element(expected.begin(), expected.end());
    for (std::size_t i = 0; i < got.size(); ++i)
      EXPECT_NEAR(got[i], expected[i], std::max(5e-3 * expected[i], 5e-6 * brightest))
          << shape << ", geometry " << i << ", " << expected[i] / brightest << " of the brightest";
  }
}

// Lit sides seen almost from their edge, thinner than a sample: whether samples fall on them must
// not decide about their light.
TEST(Tile, ASliverBetweenTwoRowsOfSamplesHasItsLight) {
  const Mesh mesh = box_wing({}, named("white-paint"), named("white-paint"), named("white-paint"));
  const FacetLight object(mesh, Band{});
  const Vec<Body> sun = unit(Vec<Body>{-0.53, 0.85, 0.1});
  for (const double grazing : {3e-4, 1e-3, 3.4e-3, 0.01, 0.03})
    for (int shift = 0; shift < 60; ++shift) {
      const Vec<Body> viewer = unit(Vec<Body>{0.95, grazing, -0.3 + 1e-5 * shift});
      TileCamera camera = camera_around(radius_m(mesh), far_m, 34);
      camera.principal_x_px += 0.0137 * shift;
      camera.principal_y_px += 0.0071 * shift;
      const double expected =
          sun_photons * object.reflected_m2_per_sr(sun, viewer) / (far_m * far_m);
      const double got = flux(draw(object, sun, viewer, camera, 0.03 * (shift % 7), 16), camera);
      ASSERT_GT(expected, 0.0);
      EXPECT_NEAR(got / expected, 1.0, 5e-3) << grazing << " rad, " << shift;
    }
}

/// Thin objects of 3 m, and a disc from its edge, 3 m across.
std::vector<NamedMesh> thin_shapes() {
  const Material white = named("white-paint");
  return {{"boom", box({0.002, 0.002, 3}, white)},
          {"sheet", box({3, 3, 0.001}, white)},
          {"mast", cylinder(0.001, 3, 12, white)},
          {"disc", cylinder(1.5, 0.001, 64, white)}};
}

// Objects thinner than the samples from all sides, and with half of them beside the tile.
TEST(Tile, AnObjectThinnerThanTheSamplesHasItsLight) {
  const auto directions = even_directions<Body>(40);
  for (const auto& [shape, mesh] : thin_shapes()) {
    const FacetLight object(mesh, Band{});
    for (const int pixels : {12, 97, 1300})
      for (std::size_t i = 0; i < (pixels > 1000 ? 3 : 40); ++i) {
        const Vec<Body> viewer = i ? directions[i] : Vec<Body>{1, 0, 0};
        const Vec<Body> sun = unit(viewer + directions[(i * 7 + 3) % 40] * 0.8);
        const double expected =
            sun_photons * object.reflected_m2_per_sr(sun, viewer) / (far_m * far_m);
        const TileCamera camera = camera_around(2.2, far_m, pixels);
        const double roll = 0.7 * double(i);
        const int oversampling = std::clamp(512 / pixels, 4, 64);
        EXPECT_NEAR(flux(draw(object, sun, viewer, camera, roll, oversampling), camera) / expected,
                    1.0, 5e-3)
            << shape << ", " << pixels << " px, geometry " << i;
        if (pixels < 50) continue;
        double parts = 0;
        for (const int right : {0, 1}) {
          TileCamera part = camera;
          part.left = right * (pixels / 2);
          part.columns = right ? pixels - pixels / 2 : pixels / 2;
          parts += flux(draw(object, sun, viewer, part, roll, oversampling), part);
        }
        EXPECT_NEAR(parts / expected, 1.0, 5e-3)
            << shape << " in two, " << pixels << " px, geometry " << i;
      }
  }
}

TEST(Tile, AWarmObjectThinnerThanTheSamplesHasItsLightInTheThermalBand) {
  const Band thermal{.name = "N", .centre_m = 10e-6, .width_m = 4e-6};
  const auto directions = even_directions<Body>(20);
  for (const auto& [shape, mesh] : thin_shapes()) {
    const FacetLight object(mesh, thermal);
    const TileCamera camera = camera_around(2.2, far_m, 97);
    for (std::size_t i = 0; i < 20; ++i) {
      const Vec<Body>&viewer = directions[i], sun = directions[(i * 7 + 3) % 20];
      const Tile tile = renderer().draw({.mesh = &object.mesh(),
                                         .bands = {{&object.facets(), 0.0}},
                                         .camera_from_body = looking_along(-viewer, 0.3),
                                         .object_m = {0, 0, far_m},
                                         .sources = {{sun, 1.0}},
                                         .camera = camera,
                                         .oversampling = 5});
      EXPECT_NEAR(flux(tile, camera) * far_m * far_m / object.emitted_photons_per_s_sr(viewer), 1.0,
                  5e-3)
          << shape << ", geometry " << i;
    }
  }
}

// What the shadow takes from the picture is what it takes from the sum.
TEST(Tile, ShowsTheShadowThatOnePartThrowsOnAnother) {
  const Material white = named("white-paint");
  const Mesh mesh = merged(plate(4, 4, white, white), moved(plate(1, 1, white, white), {0, 0, 1}));
  const FacetLight object(mesh, Band{});
  const TileCamera camera = camera_around(2.0, far_m, 64);
  const Vec<Body> sun = unit(Vec<Body>{1.5, 0, 1});  // shadow 1.5 m aside, beyond the front plate
  const Tile tile = draw(object, sun, {0, 0, 1}, camera, 0.0, 8);
  const auto dark =
      std::count_if(tile.radiance.begin(), tile.radiance.end(), [](float r) { return r < 1e12f; });
  EXPECT_NEAR(double(dark), 256.0, 1.0);  // 1 m of 4 is 16 of 64 pixels
  EXPECT_NEAR(flux(tile, camera) / (sun_photons * object.reflected_m2_per_sr(sun, {0, 0, 1})) *
                  far_m * far_m,
              1.0, 1e-3);
}

TEST(Tile, ChannelsAreTheBandsEachAsDrawnAlone) {
  const Mesh mesh = box_wing({}, named("kapton"), named("silicon-cell"), named("aluminium"));
  std::vector<FacetLight> lights;
  for (const double centre_um : {0.45, 0.55, 0.8, 0.95, 1.4})
    lights.emplace_back(mesh, Band{.centre_m = centre_um * um, .width_m = 0.05 * um});
  const TileCamera camera = camera_around(radius_m(mesh), far_m, 32);
  TileScene scene{.mesh = &mesh,
                  .bands = {},
                  .camera_from_body = looking_along(unit(Vec<Body>{0.2, 0.4, -1}), 0.3),
                  .object_m = {0, 0, far_m},
                  .sources = {{unit(Vec<Body>{0.4, 0.1, 1}), 1.0}},
                  .camera = camera};
  for (const auto& light : lights) scene.bands.push_back({&light.facets(), sun_photons});
  const Tile all = renderer().draw(scene);
  for (std::size_t k = 0; k < lights.size(); ++k) {
    scene.bands = {{&lights[k].facets(), sun_photons}};
    const Tile one = renderer().draw(scene);
    EXPECT_EQ(one.coverage, all.coverage);
    for (int y = 0; y < all.rows; ++y)
      for (int x = 0; x < all.columns; ++x)
        ASSERT_EQ(all.at(x, y, int(k)), one.at(x, y, 0)) << k << " " << x << " " << y;
  }
}

// Gold foil, whose reflectance climbs from 0.37 to 0.97 across a wide band: drawn at sixteen
// wavelengths in the tile's channels and summed by the photons that the Sun sends in each, it is
// what the unresolved object has in the whole band, and that is not what it has at the band's
// middle.
TEST(Tile, AColouredMaterialHasTheLightOfItsBandInChannelsAndUnresolved) {
  Material gold = sandford_robertson_of(
      "gold", {{0.45e-6, 0.50e-6, 0.55e-6, 0.60e-6, 0.70e-6}, {0.37, 0.45, 0.80, 0.92, 0.97}}, 0.3,
      0.3, 0.3);
  const Mesh mesh = box_wing({}, gold, gold, gold);
  const Band wide{.name = "wide", .centre_m = 0.55 * um, .width_m = 0.24 * um};
  constexpr int count = 16;
  std::vector<FacetLight> lights;
  std::vector<double> photons;
  for (int k = 0; k < count; ++k) {
    const Band narrow{.name = "k",
                      .centre_m = wide.low_m() + (k + 0.5) / count * wide.width_m,
                      .width_m = wide.width_m / count};
    lights.emplace_back(mesh, narrow);
    photons.push_back(sunlight_photons_per_s_m2(sun_v_mag, narrow));
  }
  const Vec<Body> sun = unit(Vec<Body>{0.4, 0.3, 1}), viewer = unit(Vec<Body>{-0.2, 0.4, 1});
  const TileCamera camera = camera_around(radius_m(mesh), far_m, 64);
  TileScene scene{.mesh = &mesh,
                  .bands = {},
                  .camera_from_body = looking_along(-viewer, 0.3),
                  .object_m = {0, 0, far_m},
                  .sources = {{sun, 1.0}},
                  .camera = camera,
                  .oversampling = 8};
  for (int k = 0; k < count; ++k)
    scene.bands.push_back({&lights[std::size_t(k)].facets(), photons[std::size_t(k)]});
  const Tile tile = renderer().draw(scene);
  double channels = 0, unresolved = 0;
  for (int k = 0; k < count; ++k) channels += flux(tile, camera, k);
  const FacetLight whole(mesh, wide);
  unresolved = sunlight_photons_per_s_m2(sun_v_mag, wide) * whole.reflected_m2_per_sr(sun, viewer) /
               (far_m * far_m);
  EXPECT_NEAR(channels / unresolved, 1.0, 5e-3);
  const FacetLight middle(mesh, Band{.centre_m = 0.55 * um, .width_m = 1e-9});
  EXPECT_GT(
      std::abs(middle.reflected_m2_per_sr(sun, viewer) / whole.reflected_m2_per_sr(sun, viewer) -
               1.0),
      0.02);
}

TEST(Tile, IsTheSameToTheBitEveryTimeAndInPieces) {
  const Mesh mesh = box_wing({}, named("kapton"), named("silicon-cell"), named("aluminium"));
  const FacetLight object(mesh, Band{});
  const Vec<Body> sun = unit(Vec<Body>{0.4, 0.1, 1}), viewer = unit(Vec<Body>{-0.3, 0.2, 1});
  const TileCamera camera = camera_around(radius_m(mesh), far_m, 300);  // nine pieces
  const Tile a = draw(object, sun, viewer, camera, 0.3, 4);
  const Tile b = draw(object, sun, viewer, camera, 0.3, 4);
  EXPECT_EQ(a.radiance, b.radiance);
  // The middle of the same picture as a tile of its own: the same light but for single samples.
  TileCamera middle = camera;
  middle.left = middle.top = 100;
  middle.columns = middle.rows = 100;
  const Tile part = draw(object, sun, viewer, middle, 0.3, 4);
  double whole_sum = 0, part_sum = 0;
  for (int y = 0; y < 100; ++y)
    for (int x = 0; x < 100; ++x) {
      whole_sum += a.at(x + 100, y + 100, 0);
      part_sum += part.at(x, y, 0);
    }
  EXPECT_NEAR(part_sum / whole_sum, 1.0, 1e-3);
}

// Warm panels: in the thermal band the night side shines, at the radiance of its temperature.
TEST(Tile, WarmPanelsShineInTheThermalBand) {
  const Band thermal{.name = "N", .centre_m = 10e-6, .width_m = 4e-6};
  const Mesh mesh = plate(2, 2, named("white-paint"), named("black-paint"));
  const FacetLight object(mesh, thermal);
  const TileCamera camera = camera_around(1.0, far_m, 16);
  const Tile tile = draw(object, {0, 0, 1}, {0, 0, -1}, camera, 0.0, 4);
  const double expected = object.emitted_photons_per_s_sr({0, 0, -1}) / 4.0;  // the plate has 4 m2
  EXPECT_GT(expected, 1e20);
  EXPECT_NEAR(tile.at(8, 8, 0) / expected, 1.0, 1e-5);
}

TEST(Tile, EarthshineLightsTheSideThatTheSunDoesNot) {
  const Mesh mesh = box({1, 1, 1}, named("white-paint"));
  const FacetLight object(mesh, Band{});
  const std::vector<LightSource> sources{{{0, 0, 1}, 1.0}, {{0, 0, -1}, 0.1}};
  const TileCamera camera = camera_around(1.0, far_m, 32);
  const Tile tile = renderer().draw({.mesh = &mesh,
                                     .bands = {{&object.facets(), sun_photons}},
                                     .camera_from_body = looking_along({0, 0, 1}, 0.0),
                                     .object_m = {0, 0, far_m},
                                     .sources = sources,
                                     .camera = camera});
  EXPECT_NEAR(flux(tile, camera) * far_m * far_m /
                  (sun_photons * object.reflected_m2_per_sr(sources, {0, 0, -1})),
              1.0, 5e-3);
  EXPECT_GT(tile.at(16, 16, 0), 0.0f);
}

}  // namespace
}  // namespace dmise
