#include "sensors/observatory/scenario_sky.h"

#include <erfa.h>

#include <algorithm>

#include "sensors/sky/sky_light.h"

namespace dmise {
namespace {

/// The sensor where it does not matter where it points.
SensorConfig looking_up(SensorConfig sensor) {
  sensor.pointing = PointUp{};
  sensor.tracking = Tracking::fixed;
  sensor.camera.exclusion = {};
  return sensor;
}

}  // namespace

ScenarioSky::ScenarioSky(const Scenario& scenario, const SensorConfig& sensor, const Clock& clock)
    : scenario_(scenario),
      sensor_(looking_up(sensor)),
      clock_(clock),
      windows_(scenario, sensor, clock),
      states_(nothing_, clock, threads_) {}

template <class Ask>
auto ScenarioSky::ask(SimTime t, const Ask& ask) const {
  // Beyond the run the sky stands still: exposures end within it.
  t = std::clamp(t, SimTime{0}, scenario_.duration);
  const FrameTimes instant{1, t, t, t};
  const StateWindow window = windows_.around(instant, nothing_, states_);
  return ask(View(sensor_, instant, window, scenario_.seed, Belief::believed), t);
}

Vec<Enu> ScenarioSky::seen(const Equatorial& icrs, SimTime t) const {
  return ask(t, [&](const View& view, SimTime at) {
    return view.enu_from_gcrs(at) * view.places(at).seen(direction_of<Gcrs>(icrs));
  });
}

Equatorial ScenarioSky::star_seen_at(const Vec<Enu>& direction, SimTime t) const {
  return ask(t, [&](const View& view, SimTime at) {
    return equatorial_of(
        view.places(at).star_seen_at(view.enu_from_gcrs(at).inverse() * direction));
  });
}

Vec<Gcrs> ScenarioSky::gcrs(const Vec<Enu>& direction, SimTime t) const {
  return ask(t, [&](const View& view, SimTime at) {
    return view.enu_from_gcrs(at).inverse() * direction;
  });
}

SiteConditions ScenarioSky::conditions(SimTime t) const {
  return ask(t, [](const View& view, SimTime at) {
    return site_conditions(view.sensor(), view.weather(), sky_over(view, {}), at.seconds());
  });
}

std::shared_ptr<const SatellitePath> ScenarioSky::path_of(const MeanElements& elements) const {
  return std::make_shared<const SatellitePath>(scenario_, sensor_, clock_, elements);
}

double ScenarioSky::sidereal_time_rad(SimTime t) const {
  const Ut1 ut1 = clock_.ut1(t);
  const Tt tt = clock_.tt(t);
  const double greenwich = eraGst06a(ut1.jd1, ut1.jd2, tt.jd1, tt.jd2);
  return eraAnp(greenwich + site_of(sensor_)->longitude_deg * deg);
}

}  // namespace dmise
