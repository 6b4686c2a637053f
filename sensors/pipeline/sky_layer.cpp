#include "sensors/pipeline/sky_layer.h"

#include <algorithm>
#include <vector>

#include "core/base/error.h"
#include "core/optics/projection.h"
#include "core/sky/surface_brightness.h"
#include "sensors/pipeline/light.h"

namespace dmise {
namespace {

constexpr int cell_px = 16;

double zenith_mag(const View& view) {
  for (const auto& sky : view.environment().skies)
    if (sky.sensor == view.sensor().name) return sky.zenith_mag_per_arcsec2;
  throw Error(view.sensor().name + ": the environment has no sky for this sensor");
}

}  // namespace

void fill_sky(const View& view, RateImage& image, Threads& threads) {
  const auto& optics = view.sensor().camera.optics;
  std::fill(image.pixels.begin(), image.pixels.end(), 0.0f);
  if (!view.sensor().effects.has(Effect::sky)) return;
  const double electrons_per_sr =
      sky_photons_per_s_m2_sr(zenith_mag(view), view.sensor().camera.band) *
      Light(view).electrons_per_photon_m2() * view.times().seconds();

  // Expected electrons at the nodes of a grid that covers the frame.
  const int nodes_x = (optics.columns + cell_px - 1) / cell_px + 1;
  const int nodes_y = (optics.rows + cell_px - 1) / cell_px + 1;
  const auto gcrs_from_camera = view.camera_from_gcrs(view.times().middle).inverse();
  const Hidden hidden(view, view.times().middle);
  std::vector<float> node(std::size_t(nodes_x) * std::size_t(nodes_y));
  threads.for_ranges(std::size_t(nodes_y), 8, [&](std::size_t first, std::size_t last) {
    for (std::size_t j = first; j < last; ++j)
      for (int i = 0; i < nodes_x; ++i) {
        const PixelPosition pixel{double(i * cell_px), double(j * cell_px)};
        const auto direction = unproject(optics, pixel);
        if (!direction || (view.on_ground() && hidden.direction(gcrs_from_camera * *direction)))
          continue;
        node[j * std::size_t(nodes_x) + std::size_t(i)] =
            static_cast<float>(electrons_per_sr * pixel_solid_angle_sr(optics, pixel) *
                               relative_illumination(optics, pixel));
      }
  });

  threads.for_ranges(std::size_t(optics.rows), 64, [&](std::size_t first, std::size_t last) {
    std::vector<float> line(static_cast<std::size_t>(nodes_x));
    for (std::size_t y = first; y < last; ++y) {
      const std::size_t j = y / cell_px;
      const float v = float(y % cell_px) / cell_px;
      for (std::size_t i = 0; i < line.size(); ++i) {
        const float upper = node[j * line.size() + i];
        line[i] = upper + v * (node[(j + 1) * line.size() + i] - upper);
      }
      float* out = image.row(int(y));
      for (int x = 0; x < optics.columns; ++x) {
        const std::size_t i = std::size_t(x) / cell_px;
        const float u = float(x % cell_px) / cell_px;
        out[x] = line[i] + u * (line[i + 1] - line[i]);
      }
    }
  });
}

}  // namespace dmise
