#include "bench/studies/field_watcher.h"

#include <fstream>
#include <optional>
#include <sstream>

#include "bench/catalogue_file.h"
#include "core/config/make_clock.h"
#include "sensors/objects/states_in_field.h"

namespace dmise {
namespace {

constexpr double tick_s = 5.0;

class FieldWatcher : public Evaluator {
 public:
  FieldWatcher(const Scenario& scenario, const std::string& name)
      : sensor_(sensor_named(scenario, name)),
        own_(scenario.own_objects),
        clock_(make_clock(scenario)),
        tick_(scenario.tick),
        takes_states_(!scenario.network.sensors_propagate),
        window_(scenario.interpolation, scenario.last_tick()) {}

  std::string name() const override { return sensor_.name; }
  std::vector<std::string> produces() const override { return {detection_prefix + sensor_.name}; }
  std::vector<std::string> consumes() const override {
    return {takes_states_ ? objects_topic : roster_topic, environment_topic,
            site_prefix + sensor_.name};
  }

  std::vector<Message> step(Tick tick, std::span<const Message> inputs) override {
    for (const Message& message : inputs) take_in(message);
    if (!takes_states_) window_.add_tick(tick, {tick * tick_.ns});
    const FrameTimes exposure = frame_times(sensor_, frame_);
    if (exposure.end.ns > tick * tick_.ns) return {};
    if (states_) {
      watch(states_->around(window_, sensor_, exposure), exposure);
    } else {
      watch(window_, exposure);
    }
    window_.forget_before(frame_times(sensor_, ++frame_).start);
    return {};
  }

 private:
  void take_in(const Message& message) {
    const auto& state = message.state;
    if (takes_states_ || !std::holds_alternative<ObjectRoster>(*state)) return window_.add(state);
    const auto objects = propagated_objects(state, own_, clock_, wgs84);
    window_.add(std::shared_ptr<const ObjectRoster>(objects, &objects->population.roster));
    states_.emplace(objects, tick_);
  }

  /// Places of the objects in the field at start, middle and end.
  void watch(const StateWindow& window, const FrameTimes& exposure) {
    const View view(sensor_, exposure, window);
    for (const std::size_t i : objects_in_field(view))
      for (const SimTime t : {exposure.start, exposure.middle, exposure.end})
        path_m_ += norm(window.motion(i, t).position_m - view.observer(t).position_m);
  }

  SensorConfig sensor_;
  std::vector<OwnObject> own_;
  Clock clock_;
  SimTime tick_;
  bool takes_states_;
  StateWindow window_;
  std::optional<StatesInField> states_;
  std::uint32_t frame_ = 1;
  double path_m_ = 0.0;
};

}  // namespace

Scenario telescope_network(int sensors, Tick ticks, const std::filesystem::path& directory) {
  std::filesystem::create_directories(directory);
  const WrittenCatalogue catalogue = catalogue_of_18470(directory);
  std::ostringstream text;
  text << "simulation: {start: " << catalogue.start_utc
       << ", duration_s: " << tick_s * double(ticks) << ", tick_s: " << tick_s
       << "}\nobjects: [{catalogue: " << catalogue.path << "}]\nsensors:\n";
  for (int i = 0; i < sensors; ++i)
    text << "  - {name: telescope-" << i + 1 << ", site: {latitude_deg: " << -40 + 8 * (i % 10)
         << ", longitude_deg: " << 18 * (i / 10) << ", height_m: 200}, camera: raven, "
         << "pointing: {azimuth_deg: " << 36 * (i % 10) << ", elevation_deg: " << 30 + i % 60
         << "}, exposure_s: " << tick_s << ", cadence_s: " << tick_s << "}\n";
  const auto path = directory / "telescopes.yaml";
  std::ofstream(path) << text.str();
  return load_scenario(path.string());
}

std::unique_ptr<Participant> make_field_watcher(const Scenario& scenario, const std::string& name) {
  return std::make_unique<FieldWatcher>(scenario, name);
}

}  // namespace dmise
