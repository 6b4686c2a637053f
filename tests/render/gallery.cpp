// Draws the pictures of docs/gallery and the figures behind docs/models/rendering.md:
//   draw-gallery FOLDER
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <ctime>
#include <fstream>

#include "core/base/units.h"
#include "core/facets/earthshine.h"
#include "core/materials/obj_file.h"
#include "core/photometry/magnitude.h"
#include "core/pictures/picture_file.h"
#include "tests/render/scenes.h"

namespace dmise {
namespace {

constexpr double band_um[3] = {0.61, 0.55, 0.45};

/// Red, green and blue as a screen shows them; the brightest two in a thousand pixels are white.
Picture shown(const Tile& tile) {
  std::vector<float> sorted = tile.radiance;
  std::sort(sorted.begin(), sorted.end());
  const float white = sorted[std::size_t(double(sorted.size()) * 0.998)];
  Picture picture{.columns = tile.columns, .rows = tile.rows, .channels = 3, .pixels = {}};
  for (const float r : tile.radiance)
    picture.pixels.push_back(
        std::uint8_t(std::lround(255 * std::pow(std::clamp(r / white, 0.0f, 1.0f), 1 / 2.2f))));
  return picture;
}

void draw_picture(const std::string& path, const Mesh& mesh, const Vec<Body>& viewer,
                  const Vec<Body>& sun, const Vec<Body>& earth_m, double roll_rad, double zoom) {
  std::vector<FacetLight> lights;
  for (const double centre : band_um)
    lights.emplace_back(mesh, Band{.centre_m = centre * um, .width_m = 0.08 * um});
  std::vector<LightSource> sources{{sun, 1.0}};
  for (const auto& patch : earthshine_sources({.rings = 4}, earth_m, sun)) sources.push_back(patch);
  const double range_m = 40.0;
  TileCamera camera = camera_around(radius_m(mesh) / zoom, range_m, 480);
  camera.rows = 320;
  camera.principal_y_px = 159.5;
  const Tile tile = renderer().draw({.mesh = &mesh,
                                     .bands = {{&lights[0].facets(), 1e20},
                                               {&lights[1].facets(), 1e20},
                                               {&lights[2].facets(), 1e20}},
                                     .camera_from_body = looking_along(-viewer, roll_rad),
                                     .object_m = {0, 0, range_m},
                                     .sources = sources,
                                     .camera = camera,
                                     .oversampling = 8});
  write_picture(path, shown(tile));
}

/// A box-wing satellite that turns ten times a minute, 1000 km away: seconds and V magnitudes.
void light_curve(const std::string& path) {
  const FacetLight object(
      box_wing({}, named("kapton"), named("silicon-cell"), named("white-paint")), johnson_v());
  const Vec<Body> axis = unit(Vec<Body>{0.25, 1.0, 0.1});
  const Vec<Body> sun = unit(Vec<Body>{1.0, 0.2, 0.3}), viewer = unit(Vec<Body>{0.3, 0.1, 1.0});
  std::ofstream file(path);
  file << "seconds,v_mag\n";
  for (int i = 0; i <= 2400; ++i) {
    const double t = i * 0.005, angle = -2 * pi * t * 10 / 60;
    const auto turned = [&](const Vec<Body>& v) {
      return v * std::cos(angle) + cross(axis, v) * std::sin(angle) +
             axis * (dot(axis, v) * (1 - std::cos(angle)));
    };
    const double light = object.reflected_m2_per_sr(turned(sun), turned(viewer)) / 1e12;
    file << t << "," << sun_v_mag + magnitude_of_light(light) << "\n";
  }
}

void draw_all(const std::string& folder) {
  const auto model = load_obj(DMISE_SOURCE_DIR "/launch/models/inspector.obj",
                              [](std::string_view name) { return library().find(name); });
  for (const auto& note : model.notes) std::printf("%s\n", note.c_str());
  draw_picture(folder + "/inspector.png", model.mesh, unit(Vec<Body>{0.75, 0.35, 0.6}),
               unit(Vec<Body>{0.3, 0.75, 0.8}), {0, 0, -7000e3}, 1.2, 1.05);
  draw_picture(folder + "/box-wing.png",
               box_wing({}, named("kapton"), named("silicon-cell"), named("white-paint")),
               unit(Vec<Body>{0.8, -0.3, 0.5}), unit(Vec<Body>{-0.15, 0.75, 0.7}), {0, 0, -7000e3},
               1.2, 0.95);
  draw_picture(folder + "/starlink-like.png",
               moved(starlink_like(named("starlink-chassis"), named("starlink-array"),
                                   named("starlink-array")),
                     {0, 0, 4.1}),
               unit(Vec<Body>{0.7, 0.5, 0.45}), unit(Vec<Body>{0.5, 0.75, -0.1}), {0, 0, 7000e3},
               0.0, 0.72);
  light_curve(folder + "/light-curve.csv");
}

}  // namespace
}  // namespace dmise

int main(int argc, char** argv) {
  if (argc != 2) return 2;
  dmise::draw_all(argv[1]);
  return 0;
}
