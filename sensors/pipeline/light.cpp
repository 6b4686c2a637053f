#include "sensors/pipeline/light.h"

#include <cmath>
#include <deque>
#include <mutex>

#include "core/base/units.h"
#include "core/effects/light_effects.h"
#include "core/photometry/diffuse_sphere.h"
#include "core/photometry/magnitude.h"
#include "core/sky/airmass.h"
#include "core/sky/scintillation.h"

namespace dmise {
namespace {

constexpr double sun_bv = 0.65;

/// What the tables of an air are made of.
struct AirKey {
  Band band;
  Curve extinction;
  std::optional<Clouds> clouds;

  bool operator==(const AirKey&) const = default;
};

/// Tables cost milliseconds: those of the airs used last are kept.
std::shared_ptr<const AirTables> tables_of(const AirKey& key) {
  struct Kept {
    AirKey key;
    std::shared_ptr<const AirTables> tables;
  };
  constexpr std::size_t most = 64;
  static std::mutex mutex;
  static std::deque<Kept> kept;
  std::lock_guard lock(mutex);
  for (const Kept& one : kept)
    if (one.key == key) return one.tables;
  auto tables = std::make_shared<AirTables>(
      AirTables{BandExtinction(key.band, key.extinction),
                key.clouds ? std::optional(CloudMap(*key.clouds)) : std::nullopt});
  kept.push_front({key, tables});
  if (kept.size() > most) kept.pop_back();
  return tables;
}

}  // namespace

Curve extinction_over(const View& view) {
  Curve curve = view.sensor().atmosphere.extinction_mag_per_airmass;
  if (!view.air() || curve.empty()) return curve;
  const double told = view.air()->extinction_mag_per_airmass;
  const double here = curve.at_or_end(550 * nm);
  if (told == here || !(here > 0)) return curve;
  for (double& k : curve.value) k *= told / here;
  return curve;
}

Light::Light(const View& view) : up_(view.up(view.times().middle)) {
  const auto& sensor = view.sensor();
  const auto& camera = sensor.camera;
  electrons_per_photon_m2_ = camera.optics.collecting_area_m2() * camera.optics.transmission *
                             camera.detector.quantum_efficiency;
  zero_mag_photons_per_s_m2_ = object_photons_per_s_m2(0.0, camera.band);
  if (!view.on_ground()) return;
  air_ = tables_of({camera.band, extinction_over(view), sensor.weather.clouds});
  with_extinction_ = sensor.effects.has(effect::extinction);
  with_clouds_ = sensor.effects.has(effect::clouds) && air_->clouds;
  with_flicker_ = sensor.effects.has(effect::scintillation);
  flicker_key_ = rng_key(view.seed(), sensor.name, view.times().frame, "scintillation");
  flicker_at_zenith_ = scintillation_sigma(camera.optics.aperture_m, view.times().seconds(), 1.0,
                                           view.site()->height_m);
  time_s_ = view.times().middle.seconds();
  enu_from_gcrs_ = view.enu_from_gcrs(view.times().middle);
}

double Light::elevation_rad(const Vec<Gcrs>& apparent) const {
  return std::asin(std::clamp(dot(up_, apparent), -1.0, 1.0));
}

double Light::air_transmission(const Vec<Gcrs>& apparent, double bv) const {
  return with_extinction_ ? air_->extinction.of_star(airmass(elevation_rad(apparent)), bv) : 1.0;
}

double Light::cloud_transmission(const Vec<Gcrs>& apparent) const {
  return with_clouds_ ? air_->clouds->transmission(enu_from_gcrs_ * apparent, time_s_) : 1.0;
}

double Light::transmission(const Vec<Gcrs>& apparent) const {
  return air_transmission(apparent, sun_bv) * cloud_transmission(apparent);
}

double Light::flicker(const Vec<Gcrs>& apparent, Flickering what, std::uint32_t number) const {
  if (!with_flicker_) return 1.0;
  const double x = airmass(elevation_rad(apparent));
  const double sigma = std::min(1.0, flicker_at_zenith_ * x * std::sqrt(x));
  const double log_variance = std::log1p(sigma * sigma);
  const double z = normal_of(rng_word(flicker_key_, number, what == Flickering::star ? 0 : 1));
  return std::exp(std::sqrt(log_variance) * z - 0.5 * log_variance);
}

double Light::zero_point_mag() const {
  return -magnitude_of_light(zero_mag_photons_per_s_m2_ * electrons_per_photon_m2_);
}

double Light::extinction_mag_per_airmass() const {
  return with_extinction_ ? magnitude_of_light(air_->extinction.of_sunlight(1.0)) : 0.0;
}

Hidden::Hidden(const View& view, SimTime t)
    : on_(view.sensor().effects.has(effect::earth_occultation)), up_(view.up(t)) {
  if (on_ && !view.on_ground())
    sight_.emplace(view.observer(t).position_m, oblate_earth(view.earth()));
}

bool Hidden::direction(const Vec<Gcrs>& apparent) const {
  if (!on_) return false;
  return sight_ ? !sight_->clear_direction(apparent) : dot(up_, apparent) < 0.0;
}

bool Hidden::object(const Vec<Gcrs>& position_m, const Vec<Gcrs>& apparent) const {
  if (!on_) return false;
  return sight_ ? !sight_->clear(position_m) : dot(up_, apparent) < 0.0;
}

}  // namespace dmise
