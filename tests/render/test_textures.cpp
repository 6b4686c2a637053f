#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "tests/render/scenes.h"

namespace dmise {
namespace {

constexpr int side = 64;  // side of every picture [px]

LinearPicture picture_of(int channels, const auto& value) {
  LinearPicture picture{side, side, channels, {}};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      for (int c = 0; c < channels; ++c) picture.pixels.push_back(float(value(x, y, c)));
  return picture;
}

/// 8 x 8 fields of 0.2 and 0.8; the one at the upper left of the picture is 0.5.
double check(int x, int y, int) {
  if (x < side / 8 && y < side / 8) return 0.5;
  return (x / (side / 8) + y / (side / 8)) % 2 ? 0.8 : 0.2;
}

/// A mesh whose material file and picture are given. `f` has texture numbers.
Mesh textured(const std::string& obj, const std::string& mtl, const LinearPicture& picture) {
  return parse_obj("mtllib a.mtl\nusemtl hull\n" + obj, "a.obj",
                   {[&](const std::string&) { return "newmtl hull\n" + mtl; },
                    [](std::string_view) { return std::optional<Material>(); },
                    [&](const std::string&, PictureOf) { return picture; }})
      .mesh;
}

/// 2 m x 2 m about the origin, facing +z; the picture's right is +x, its top +y.
const std::string square =
    "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n"
    "f 1/1 2/2 3/3 4/4\n";

const std::string cube =
    "v -1 -1 -1\nv 1 -1 -1\nv 1 1 -1\nv -1 1 -1\nv -1 -1 1\nv 1 -1 1\nv 1 1 1\nv -1 1 1\n"
    "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nf 1/1 4/2 3/3 2/4\nf 5/1 6/2 7/3 8/4\nf 1/1 2/2 6/3 5/4\n"
    "f 2/1 3/2 7/3 6/4\nf 3/1 4/2 8/3 7/4\nf 4/1 1/2 5/3 8/4\n";

struct View {
  Vec<Body> sun, viewer;
  double roll_rad;
};

/// Radiance of the pixel in which a point of the body falls.
double radiance_at(const Tile& tile, const TileCamera& camera, const View& view,
                   const Vec<Body>& point_m) {
  const Vec<CameraFrame> p = looking_along(-view.viewer, view.roll_rad) * point_m;
  const double x = camera.principal_x_px + camera.focal_px * p.x / (far_m + p.z);
  const double y = camera.principal_y_px + camera.focal_px * p.y / (far_m + p.z);
  return tile.at(int(std::lround(x)), int(std::lround(y)), 0);
}

double lambert(double reflectance, double cos_in) {
  return reflectance / pi * sun_photons * cos_in;
}

/// The light of the pixels of a tile is that of the object's facets, from 60 sides: to 5e-3 of
/// itself and `floor` of the brightest.
void expect_pixels_sum_to_the_facets(const FacetLight& object, int pixels, int oversampling,
                                     double floor) {
  const auto directions = even_directions<Body>(60);
  const TileCamera camera = camera_around(1.8, far_m, pixels);
  double brightest = 0;
  for (const Vec<Body>& side : directions)
    brightest = std::max(brightest, object.reflected_m2_per_sr(side, side));
  for (int i = 0; i < 60; ++i) {
    const Vec<Body> sun = directions[std::size_t(i)];
    const Vec<Body> viewer = directions[std::size_t((i * 7 + 3) % 60)];
    const double expected = object.reflected_m2_per_sr(sun, viewer);
    const double got = flux(draw(object, sun, viewer, camera, 0.4 * i, oversampling), camera) *
                       far_m * far_m / sun_photons;
    EXPECT_NEAR(got, expected, 5e-3 * expected + floor * brightest) << i;
  }
}

TEST(Texture, ACheckerboardIsWhereItsPlacesSay) {
  const Mesh mesh = textured(square, "Kd 0.9 0.9 0.9\nmap_Kd a.png\n", picture_of(3, check));
  const FacetLight object(mesh, Band{});
  const TileCamera camera = camera_around(1.5, far_m, 120);
  for (const double roll : {0.0, 0.7, 2.5}) {
    const View view{unit(Vec<Body>{0.3, 0.2, 1}), unit(Vec<Body>{-0.1, 0.2, 1}), roll};
    const Tile tile = draw(object, view.sun, view.viewer, camera, roll, 8);
    for (int row = 0; row < 8; ++row)
      for (int column = 0; column < 8; ++column) {
        const Vec<Body> middle{-1 + (column + 0.5) / 4, 1 - (row + 0.5) / 4, 0};
        const double value = check(column * 8, row * 8, 0);
        EXPECT_NEAR(radiance_at(tile, camera, view, middle), lambert(0.9 * value, view.sun.z),
                    2e-3 * lambert(0.9, 1))
            << row << " " << column << " " << roll;
      }
  }
}

// Mean of the picture, by counting its texels.
TEST(Texture, MeansAgreeWithTheIntegral) {
  const LinearPicture picture = picture_of(3, check);
  double mean = 0;
  for (const float v : picture.pixels) mean += v;
  mean /= double(picture.pixels.size());
  const Mesh mesh = textured(square, "Kd 0.9 0.9 0.9\nmap_Kd a.png\n", picture);
  const Vec<Body> sun = unit(Vec<Body>{0.3, 0.2, 1}), viewer = unit(Vec<Body>{-0.1, 0.2, 1});
  EXPECT_NEAR(FacetLight(mesh, Band{}).reflected_m2_per_sr(sun, viewer) /
                  (4.0 * 0.9 * mean / pi * sun.z * viewer.z),
              1.0, 1e-3);
  // A corner of the picture twice as large as life: a quarter of it, mirrored and moved.
  const Mesh quarter =
      textured(square, "Kd 0.9 0.9 0.9\nmap_Kd -s -0.5 0.5 1 -o 0.5 0.5 a.png\n", picture);
  double corner = 0;  // u from 0.5 to 0, v from 0.5 up to 1: the upper left
  for (int y = 0; y < side / 2; ++y)
    for (int x = 0; x < side / 2; ++x) corner += check(x, y, 0) / (side * side / 4);
  EXPECT_NEAR(FacetLight(quarter, Band{}).reflected_m2_per_sr(sun, viewer) /
                  (4.0 * 0.9 * corner / pi * sun.z * viewer.z),
              1.0, 2e-3);
}

TEST(Texture, PixelsSumToTheFacets) {
  const FacetLight object(
      textured(cube, "Kd 0.7 0.7 0.7\nKs 0.2 0.2 0.2\nNs 8\nmap_Kd a.png\n", picture_of(3, check)),
      Band{});
  for (const int pixels : {8, 60}) {
    SCOPED_TRACE(pixels);
    expect_pixels_sum_to_the_facets(object, pixels, pixels < 10 ? 64 : 16, 5e-6);
  }
}

TEST(Texture, ColoursActByWavelength) {
  const Mesh mesh = textured(square, "Kd 1 1 1\nmap_Kd a.png\n",
                             picture_of(3, [](int, int, int c) { return c == 0 ? 1.0 : 0.25; }));
  const Vec<Body> up{0, 0, 1};
  const auto reflectance = [&](double wavelength_um) {
    const Band band{.centre_m = wavelength_um * um, .width_m = 0.004 * um};
    return FacetLight(mesh, band).reflected_m2_per_sr(up, up) * pi / 4.0;
  };
  EXPECT_NEAR(reflectance(0.61), 1.0, 0.02);
  EXPECT_NEAR(reflectance(0.55), 0.25, 0.02);
  EXPECT_NEAR(reflectance(0.45), 0.25, 0.02);
  EXPECT_NEAR(reflectance(0.58), 0.625, 0.03);  // half way
}

// White is `bm` metres above black. A slope of bm over 2 m tilts the normal by atan(bm / 2) away
// from where it rises.
TEST(Bump, ASlopeTiltsTheNormalByItsGradient) {
  const View view{unit(Vec<Body>{0.4, 0.3, 1}), {0, 0, 1}, 0.3};
  const TileCamera camera = camera_around(1.5, far_m, 90);
  for (const double bm : {0.5, -0.8})
    for (const bool along_x : {true, false}) {
      const LinearPicture slope = picture_of(1, [&](int x, int y, int) {
        return ((along_x ? x : side - 1 - y) + 0.5) / side;  // rises to the right, or up
      });
      const Mesh mesh = textured(
          square, "Kd 0.6 0.6 0.6\nmap_Bump -clamp on -bm " + std::to_string(bm) + " h.png\n",
          slope);
      const FacetLight object(mesh, Band{});
      const Tile tile = draw(object, view.sun, view.viewer, camera, view.roll_rad, 8);
      const Vec<Body> normal = unit(along_x ? Vec<Body>{-bm / 2, 0, 1} : Vec<Body>{0, -bm / 2, 1});
      const double expected = lambert(0.6, dot(normal, view.sun));
      for (const Vec<Body>& at : {Vec<Body>{0, 0, 0}, {0.4, -0.5, 0}, {-0.6, 0.3, 0}})
        EXPECT_NEAR(radiance_at(tile, camera, view, at) / expected, 1.0, 2e-3) << bm << along_x;
    }
}

// Waves of 0.1 m peak to peak over 1 m: slopes to 17 deg.
TEST(Bump, PixelsSumToTheFacets) {
  const FacetLight object(
      textured(cube, "Kd 0.5 0.5 0.5\nKs 0.3 0.3 0.3\nNs 4\nbump -bm 0.1 h.png\n",
               picture_of(1,
                          [](int x, int y, int) {
                            return 0.5 + 0.25 * std::sin(4 * pi * (x + 0.5) / side) +
                                   0.25 * std::sin(4 * pi * (y + 0.5) / side);
                          })),
      Band{});
  expect_pixels_sum_to_the_facets(object, 60, 16, 5e-4);
}

TEST(Texture, EqualScenesAreEqualPixels) {
  const FacetLight object(
      textured(cube, "Kd 1 1 1\nmap_Kd a.png\nmap_Bump b.png\n", picture_of(3, check)), Band{});
  const Vec<Body> sun = unit(Vec<Body>{0.3, 0.2, 1}), viewer = unit(Vec<Body>{-0.4, 0.2, 1});
  const TileCamera camera = camera_around(1.8, far_m, 40);
  EXPECT_EQ(draw(object, sun, viewer, camera, 0.1, 8).radiance,
            draw(object, sun, viewer, camera, 0.1, 8).radiance);
}

}  // namespace
}  // namespace dmise
