#include "sensors/observatory/satellite_path.h"

#include <algorithm>

#include "core/orbit/elements/catalogue.h"
#include "sensors/observatory/device_error.h"
#include "sensors/scene/view.h"

namespace dmise {
namespace {

constexpr std::size_t max_bytes = 2000;

ObjectPopulation only(const MeanElements& elements) {
  ObjectPopulation population;
  ObjectInfo& info = population.roster.objects.emplace_back();
  info.catalogue_number = elements.catalogue_number;
  info.name = elements.name;
  population.elements.push_back(elements);
  return population;
}

}  // namespace

MeanElements elements_in(const std::string& text) {
  const auto refuse = [](const std::string& reason) {
    throw DeviceError(DeviceFault::invalid_value, "the element set: " + reason);
  };
  if (text.size() > max_bytes) refuse("is longer than 2000 bytes");
  try {
    const CatalogueFile file = parse_catalogue(text, "text");
    if (!file.refused.empty()) refuse(file.refused.front().reason);
    if (file.elements.size() != 1)
      refuse("there must be one, got " + std::to_string(file.elements.size()));
    return file.elements.front();
  } catch (const ConfigError& error) {
    refuse(error.what());
  }
  return {};
}

SatellitePath::SatellitePath(const Scenario& scenario, const SensorConfig& sensor,
                             const Clock& clock, const MeanElements& elements)
    : scenario_(scenario),
      sensor_(sensor),
      population_(only(elements)),
      states_(population_, clock, threads_),
      windows_(scenario, sensor, clock) {}

Vec<Enu> SatellitePath::seen(SimTime t) const {
  t = std::clamp(t, SimTime{0}, scenario_.duration);
  const FrameTimes instant{1, t, t, t};
  const StateWindow window = windows_.around(instant, population_, states_);
  if (!window.has_state(0, t)) throw Error("the satellite: " + window.why_no_state(0, t));
  const View view(sensor_, instant, window, scenario_.seed, Belief::believed);
  const Motion motion = window.motion(0, t);
  return view.enu_from_gcrs(t) *
         view.places(t).satellite(motion.position_m, motion.slope_m_per_s).direction;
}

}  // namespace dmise
