#include "sensors/pipeline/light.h"

#include <cmath>

#include "core/photometry/diffuse_sphere.h"
#include "core/photometry/magnitude.h"
#include "core/sky/airmass.h"

namespace dmise {

Light::Light(const View& view) : up_(view.up(view.times().middle)) {
  const auto& camera = view.sensor().camera;
  electrons_per_photon_m2_ = camera.optics.collecting_area_m2() * camera.optics.transmission *
                             camera.detector.quantum_efficiency;
  if (view.on_ground() && view.sensor().effects.has(Effect::extinction))
    extinction_mag_per_airmass_ = view.sensor().extinction_mag_per_airmass;
  zero_mag_photons_per_s_m2_ = object_photons_per_s_m2(0.0, camera.band);
}

double Light::transmission(const Vec<Gcrs>& apparent) const {
  if (extinction_mag_per_airmass_ == 0.0) return 1.0;
  const double elevation_rad = std::asin(std::clamp(dot(up_, apparent), -1.0, 1.0));
  return light_of_magnitude(extinction_mag_per_airmass_ * airmass(elevation_rad));
}

double Light::zero_point_mag() const {
  return -magnitude_of_light(zero_mag_photons_per_s_m2_ * electrons_per_photon_m2_);
}

Hidden::Hidden(const View& view, SimTime t)
    : on_(view.sensor().effects.has(Effect::earth_occultation)), up_(view.up(t)) {
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
