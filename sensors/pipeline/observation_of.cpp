#include "sensors/pipeline/observation_of.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/sky/air_exposure.h"

namespace dmise {

Observation observation_of(const View& view, const PipelineSettings& settings,
                           const std::optional<Vec<Gcrs>>& centre) {
  const auto& sensor = settings.sensor;
  const SimTime middle = view.times().middle;
  Observation o{.telescope = header_text(sensor.camera.name)};
  if (const auto target = view.target())
    o.object = header_text(view.world().roster().objects[*target].name);
  const Utc start = settings.clock.utc(view.times().start);
  o.start_mjd = (start.jd1 - mjd_zero_jd) + start.jd2;
  if (centre) {
    const auto [ra, dec] = to_spherical(*centre);
    o.ra_rad = ra < 2 * pi ? ra : 0.0;
    o.dec_rad = dec;
  }
  if (!view.on_ground()) return o;
  const Vec<Gcrs> up = view.up(middle);
  // The camera sees apparent places: this altitude has the refraction in it.
  if (const double altitude = elevation_over(up, unit(view.boresight(middle))); altitude >= 0.0)
    o.airmass = airmass(altitude);
  const auto& environment = view.environment();
  const Vec<Gcrs> here_m = view.observer(middle).position_m;
  // The Sun's light time and the Earth's aberration together: 20 arcsec.
  o.sun_altitude_rad =
      elevation_over(up, unit(unit(environment.sun_m - here_m) +
                              environment.earth_velocity_m_per_s / speed_of_light_m_per_s));
  o.moon_altitude_rad = elevation_over(up, unit(environment.moon_m - here_m));
  return o;
}

}  // namespace dmise
