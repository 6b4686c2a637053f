#include "sensors/scene/throughput.h"

#include <algorithm>

#include "core/base/stopwatch.h"
#include "core/photometry/diffuse_sphere.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/planck.h"
#include "core/sky/thermal_sky.h"

namespace dmise {

std::optional<AirGases> gases_over(const View& view) {
  if (!acts<GasAbsorption>(view.sensor().effects, view.scene())) return std::nullopt;
  return warm_air_over(view);
}

AirGases warm_air_over(const View& view) {
  const Weather& weather = view.weather();
  return {.pwv_mm = view.sensor().weather.pwv_mm.value_or(usual_pwv_mm(view.site()->height_m)),
          .pressure_hpa = std::min(weather.pressure_hpa, 1100.0),
          .temperature_k = weather.temperature_c + zero_celsius_k};
}

Curve extinction_over(const View& view) {
  Curve curve = view.sensor().atmosphere.extinction_mag_per_airmass;
  if (view.sensor().weather.pwv_mm) curve = with_haze_beyond(curve);
  if (!view.air() || curve.empty()) return curve;
  const double published = view.air()->extinction_mag_per_airmass;
  const double here = curve.at_or_end(550 * nm);
  if (published == here || !(here > 0)) return curve;
  for (double& k : curve.value) k *= published / here;
  return curve;
}

Throughput::Throughput(const View& view) {
  const auto& sensor = view.sensor();
  const auto& camera = sensor.camera;
  electrons_per_photon_m2_ = camera.optics.collecting_area_m2() * camera.optics.transmission *
                             camera.detector.quantum_efficiency;
  zero_mag_photons_per_s_m2_ = object_photons_per_s_m2(0.0, camera.band);
  if (acts<LimbExtinction>(sensor.effects, view.scene()))
    limb_.emplace(camera.band,
                  LimbSight(view.observer(view.times().middle).position_m, view.surface()));
  if (!view.on_ground()) return;
  const SimTime middle = view.times().middle;
  const Curve extinction = extinction_over(view);
  std::optional<BlownTurbulence> turbulence;
  if (acts<MovingScintillation>(sensor.effects, view.scene())) {
    const auto& over = sensor.atmosphere.turbulence;
    turbulence = over ? BlownTurbulence{over->profile, over->wind} : BlownTurbulence{};
  }
  air_.emplace(sensor.effects, view.scene(),
               AirExposure{.band = camera.band,
                           .extinction_mag_per_airmass = extinction,
                           .gases = gases_over(view),
                           .clouds = sensor.weather.clouds,
                           .turbulence = turbulence,
                           .aperture_m = camera.optics.aperture_m,
                           .exposure_s = view.times().seconds(),
                           .site_height_m = view.site()->height_m,
                           .time_s = middle.seconds(),
                           .up = view.up(middle),
                           .enu_from_gcrs = view.enu_from_gcrs(middle),
                           .seed = view.seed(),
                           .sensor = sensor.name,
                           .frame = view.times().frame});
}

double Throughput::of_air(const SightLine& line) const {
  double factor = limb_ ? limb_->of_point(line.apparent, line.distance_m) : 1.0;
  if (air_) air_->for_each([&](const auto& effect) { factor *= effect.apply(line); });
  return factor;
}

std::vector<double> Throughput::of_air(std::span<const SightLine> lines, EffectTimes& times) const {
  std::vector<double> factors(lines.size(), 1.0);
  if (limb_) {
    Stopwatch timing(times[LimbExtinction::facts]);
    for (std::size_t i = 0; i < lines.size(); ++i)
      factors[i] = limb_->of_point(lines[i].apparent, lines[i].distance_m);
  }
  if (air_)
    air_->for_each([&](const auto& effect) {
      Stopwatch timing(times[effect.facts]);
      for (std::size_t i = 0; i < lines.size(); ++i) factors[i] *= effect.apply(lines[i]);
    });
  return factors;
}

void Throughput::apply_air(const SightLines& lines, std::span<double> factors,
                           EffectTimes& times) const {
  if (limb_) {
    Stopwatch timing(times[LimbExtinction::facts]);
    for (std::size_t i = 0; i < factors.size(); ++i)
      factors[i] *= limb_->of_point(lines.apparent[i]);
  }
  if (!air_) return;
  air_->for_each([&](const auto& effect) {
    Stopwatch timing(times[effect.facts]);
    if constexpr (requires { effect.apply(lines, factors); })
      effect.apply(lines, factors);
    else
      for (std::size_t i = 0; i < factors.size(); ++i) factors[i] *= effect.apply(lines[i]);
  });
}

double Throughput::of_sunlight(const Vec<Gcrs>& apparent, double bv) const {
  const SightLine line{apparent, bv, SightLine::Source::object, 0};
  const auto* extinction = find<AirExtinction>();
  const auto* gases = find<GasAbsorption>();
  const auto* clouds = find<CloudCover>();
  return (extinction ? extinction->apply(line) : 1.0) * (gases ? gases->apply(line) : 1.0) *
         (clouds ? clouds->apply(line) : 1.0) * of_limb(apparent);
}

double Throughput::zero_point_mag() const {
  return -magnitude_of_light(zero_mag_photons_per_s_m2_ * electrons_per_photon_m2_);
}

double Throughput::extinction_mag_per_airmass() const {
  const auto* extinction = find<AirExtinction>();
  const auto* gases = find<GasAbsorption>();
  return (extinction ? extinction->sunlight_mag_per_airmass() : 0.0) +
         (gases ? gases->sunlight_mag(1.0) : 0.0);
}

}  // namespace dmise
