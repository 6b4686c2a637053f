#include "sensors/sky/thermal_optics.h"

#include "core/optics/projection.h"
#include "core/photometry/planck.h"
#include "sensors/scene/throughput.h"

namespace dmise {
namespace {

double photons_per_s_m2_sr(const View& view, double emissivity,
                           const std::optional<double>& temperature_c) {
  const double kelvin = temperature_c.value_or(view.weather().temperature_c) + zero_celsius_k;
  return emissivity * photons_of_radiance(view.sensor().camera.band, [&](double wavelength_m) {
           return planck_w_per_m2_sr_m(wavelength_m, kelvin);
         });
}

}  // namespace

PixelFunction thermal_optics_electrons(const View& view) {
  const SensorConfig& sensor = view.sensor();
  if (!acts<ThermalOptics>(sensor.effects, view.scene())) return [](double, double) { return 0.0; };
  const ThermalOptics& warm = sensor.camera.optics.thermal;
  const double electrons_per_sr =
      (photons_per_s_m2_sr(view, warm.emissivity, warm.temperature_c) +
       photons_per_s_m2_sr(view, warm.window_emissivity, warm.window_temperature_c)) *
      Throughput(view).electrons_per_photon_m2() * view.times().seconds();
  return [=, &view](double x, double y) {
    return electrons_per_sr * pixel_solid_angle_sr(view.sensor().camera.optics, {x, y}) *
           view.illumination({x, y});
  };
}

double thermal_optics_e(const View& view) {
  const PixelPosition axis = principal_point(view.sensor().camera.optics);
  return thermal_optics_electrons(view)(axis.x_px, axis.y_px);
}

}  // namespace dmise
