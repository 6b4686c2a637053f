#include "bench/bench_render.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

#include "bench/figure.h"
#include "bench/timing.h"
#include "core/base/error.h"
#include "core/base/numeric/rng.h"
#include "core/base/units.h"
#include "core/materials/shapes.h"
#include "core/optics/blur/deposit.h"
#include "sensors/render/render_module.h"

namespace dmise {
namespace {

Vec<Body> direction(int i) { return from_spherical<Body>(0.7 * i, std::asin(std::sin(1.3 * i))); }

/// A satellite of 10,000 facets that shadow each other: a tank with a ball beside it.
Mesh ten_thousand_facets(const Material& material) {
  return merged(sphere(1.0, 9700, material),
                moved(cylinder(0.5, 2.0, 80, material), {1.4, 0, 0.3}));
}

Material paint() { return sandford_robertson_of("paint", {{0.55e-6}, {0.5}}, 0.4, 0.3, 0.3); }

/// 1,000 convex bodies of 100 facets, each lit and seen from another side: milliseconds.
double unresolved_ms(double& light) {
  std::vector<FacetLight> objects;
  for (int i = 0; i < 1000; ++i)
    objects.emplace_back(cylinder(0.5 + 1e-3 * i, 2.0, 25, paint()), Band{});
  const auto all = [&] {
    for (int i = 0; i < 1000; ++i)
      light += objects[std::size_t(i)].reflected_m2_per_sr(direction(i), direction(i + 1));
  };
  return 1e3 * median_seconds(21, all, process_seconds);
}

/// One tile of 512 x 512 pixels, 4 x 4 samples each, filled by the object: light sources, shadows,
/// drawing, reading back and averaging over pixels.
double tile_ms(Renderer& renderer, double& light) {
  const FacetLight object(ten_thousand_facets(paint()), Band{});
  const double range_m = 5000.0;
  const TileScene scene{.mesh = &object.mesh(),
                        .bands = {{&object.facets(), 1.0}},
                        .camera_from_body = {},
                        .object_m = {-0.4, 0, range_m},
                        .sources = {{unit(Vec<Body>{0.8, 0.3, -0.7}), 1.0}},
                        .camera = {.focal_px = 512 / 3.0 * range_m,
                                   .principal_x_px = 255.5,
                                   .principal_y_px = 255.5,
                                   .columns = 512,
                                   .rows = 512}};
  light += renderer.draw(scene).at(256, 256, 0);
  const auto draw = [&] { light += renderer.draw(scene).at(256, 256, 0); };
  return 1e3 * median_seconds(9, draw, process_seconds);
}

/// 15,000 star trails of about 1.5 px on 3326 x 2504 pixels: as 32 snapshots by OpenGL and along
/// their paths.
void measure_snapshots(SceneRenderer& renderer, bool json) {
  constexpr int columns = 3326, rows = 2504, snapshots = 32;
  constexpr double sigma_px = 1.5 / fwhm_per_sigma;
  const RngKey key = rng_key(1, "bench", 1, "stars");
  std::vector<Arc> trails;
  for (std::uint32_t i = 0; i < 15000; ++i) {
    const auto u = [&](std::uint32_t draw) { return uniform_of(rng_word(key, i, draw)); };
    const PixelPosition at{u(0) * columns, u(1) * rows}, half{0.5 + u(2), u(3) - 0.5};
    trails.push_back({at - half, at, at + half, 1e4});
  }
  ExpectedElectronImage image(columns, rows, 100.0f);
  const ScenePlane plane{image.pixels.data(), columns, rows, columns};
  std::vector<ScenePoint> points;
  const auto draw_all = [&] {
    for (int k = 0; k < snapshots; ++k) {
      for (const Arc& trail : trails) {
        const PixelPosition at = place(trail, (k + 0.5) / snapshots);
        points.push_back({at.x_px, at.y_px, trail.signal_e / snapshots});
      }
      if (points.size() < 60000 && k + 1 < snapshots) continue;
      renderer.add_points(points, sigma_px, plane);
      points.clear();
    }
  };
  draw_all();
  Threads one(1);
  const PsfTable psf = make_psf_table(sigma_px);
  const double path_s = median_seconds(5, [&] { deposit(trails, psf, view_of(image), one); });
  const double drawn_s = median_seconds(5, draw_all, process_seconds);
  print_figure({"snapshots_frame_s", drawn_s, "s", "path integral [s]", path_s}, json);
  print_figure({"snapshots_frame_ratio", drawn_s / path_s, "1"}, json);
}

}  // namespace

int bench_render(bool json) {
  double light = 0.0;  // prevents elimination of the work
  print_figure({.name = "unresolved_1000_ms",
                .value = unresolved_ms(light),
                .unit = "ms",
                .target = 5,
                .less_is_better = true},
               json);
  try {
    const auto renderer = load_renderer();
    std::fprintf(stderr, "bench render: %s\n", renderer->description().c_str());
    print_figure({.name = "tile_ms",
                  .value = tile_ms(*renderer, light),
                  .unit = "ms",
                  .target = 200,
                  .less_is_better = true},
                 json);
    measure_snapshots(*load_scene_renderer(), json);
  } catch (const Error& error) {
    std::fprintf(stderr, "bench render: %s: the tile is skipped\n", error.what());
  }
  if (!(light > 0)) std::fprintf(stderr, "bench render: no light\n");
  return 0;
}

}  // namespace dmise
