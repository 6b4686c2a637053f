#include "sensors/frame/frame_planes.h"

#include "core/detector/exposure/expected_noise.h"
#include "core/optics/projection.h"
#include "sensors/scene/throughput.h"

namespace dmise {

RadianceMap radiance_of(const View& view, double exposure_s, const ExpectedElectronImage& light,
                        Threads& threads) {
  const auto& optics = view.sensor().camera.optics;
  const double electrons_per_photon_m2 = Throughput(view).electrons_per_photon_m2() * exposure_s;
  RadianceMap map(light.columns, light.rows);
  threads.for_ranges(std::size_t(light.rows), 16, [&](std::size_t first, std::size_t last) {
    for (std::size_t y = first; y < last; ++y)
      for (int x = 0; x < light.columns; ++x) {
        const PixelPosition pixel{double(x), double(y)};
        const double sr = pixel_solid_angle_sr(optics, pixel);
        const double per_photon = electrons_per_photon_m2 * sr * view.illumination(pixel);
        if (per_photon > 0.0) map.row(int(y))[x] = float(light.row(int(y))[x] / per_photon);
      }
  });
  return map;
}

void make_planes(const OutputConfig& wanted, const View& view, const Exposure& exposure,
                 const ExpectedElectronImage& light, Threads& threads, FramePlanes& planes) {
  const auto& sensor = view.sensor();
  if (wanted.radiance_exr) planes.radiance = radiance_of(view, exposure.exposure_s, light, threads);
  if (wanted.noise)
    planes.noise = expected_noise(light, sensor.camera.detector, exposure, sensor.effects, threads);
  const auto per_s = float(1.0 / exposure.exposure_s);
  auto& background = planes.background.pixels;
  if (wanted.sources) {
    planes.sources = ExpectedElectronImage(light.columns, light.rows);
    for (std::size_t i = 0; i < background.size(); ++i)
      planes.sources.pixels[i] = (light.pixels[i] - background[i]) * per_s;
  }
  for (float& rate : background) rate *= per_s;
}

}  // namespace dmise
