#include "sensors/scene/even_tile.h"

#include "core/optics/projection.h"
#include "sensors/scene/throughput.h"

namespace dmise {

void to_electrons(const View& view, ExtendedLight& window, Threads& threads) {
  const Optics& optics = view.sensor().camera.optics;
  const double electrons = Throughput(view).electrons_per_photon_m2() * view.times().seconds();
  auto& light = window.light;
  threads.for_ranges(std::size_t(light.rows), tile_px, [&](std::size_t begin, std::size_t end) {
    for (int j = int(begin); j < int(end); ++j)
      for (int i = 0; i < light.columns; ++i)
        if (float& e = light.at(i, j); e > 0.0f) {
          const PixelPosition at{double(window.left + i), double(window.top + j)};
          e = float(double(e) * electrons * pixel_solid_angle_sr(optics, at) *
                    view.illumination(at));
        }
  });
}

}  // namespace dmise
