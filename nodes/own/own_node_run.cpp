#include "nodes/own/own_node_run.h"

#include <algorithm>
#include <utility>

namespace dmise {
namespace {

constexpr Tick checkpoint_every = 64;  // calls

const OwnNode& node_of(const Scenario& scenario, const SensorConfig& sensor) {
  return *std::ranges::find(scenario.own_nodes, sensor.started_node(), &OwnNode::name);
}

OwnNodeSettings settings_of(const SensorConfig& sensor, const std::string& directory,
                            OwnNodeSettings settings) {
  const std::string node = sensor.started_node();
  settings.log_path = directory + "/logs/" + node + "-" + sensor.name + ".log";
  settings.error_prefix += node + ": ";
  return settings;
}

}  // namespace

v1::OwnNodeBegin begin_of(const Scenario& scenario, const OwnNode& node) {
  v1::OwnNodeBegin begin;
  begin.set_options_json(node.options_json);
  begin.set_start_utc(scenario.start_utc);
  begin.set_tick_ns(scenario.tick.ns);
  begin.set_last_tick(scenario.last_tick());
  begin.set_period_ticks(std::uint32_t(node.period_ticks));
  begin.set_seed(scenario.seed);
  return begin;
}

void describe_sensor(const SensorConfig& sensor, v1::OwnNodeSensor& told) {
  told.set_name(sensor.name);
  if (const auto* site = std::get_if<SiteConfig>(&sensor.place)) {
    told.mutable_site()->set_latitude_deg(site->latitude_deg);
    told.mutable_site()->set_longitude_deg(site->longitude_deg);
    told.mutable_site()->set_height_m(site->height_m);
  } else {
    told.set_platform(std::get<PlatformConfig>(sensor.place).object);
  }
  told.set_exposure_s(sensor.exposure_s);
  told.set_cadence_s(sensor.cadence_s);
}

bool OwnRecord::wants_checkpoint(Tick call) {
  return call % checkpoint_every == checkpoint_every - 1;
}

void OwnRecord::continue_at(v1::OwnNodeBegin& begin) {
  next_ = checkpoint_at_;
  if (checkpoint_) begin.set_checkpoint(*checkpoint_);
}

void OwnRecord::add(std::uint64_t digest, std::optional<std::string> checkpoint, const char* what) {
  if (next_ == Tick(digests_.size())) digests_.push_back(digest);
  if (digests_[std::size_t(next_)] != digest)
    throw Error("started again, its program says something else of this tick than before: its " +
                std::string(what) + " must be the same in each run");
  ++next_;
  if (!checkpoint) return;
  checkpoint_ = std::move(checkpoint);
  checkpoint_at_ = next_;
}

OwnRestarts::OwnRestarts(const NetworkConfig& network, std::string node,
                         const OwnNodeSettings& settings)
    : policy_(network.on_silent_node),
      allowed_(network.restarts),
      node_(std::move(node)),
      error_prefix_(settings.error_prefix),
      note_(settings.note) {}

void OwnRestarts::after(const ProgramLost& lost, const std::string& place) {
  const std::string text = place + ": " + lost.what();
  if (policy_ != OnSilentNode::restart || done_ >= allowed_) throw Error(error_prefix_ + text);
  ++done_;
  note_(node_ + ": " + text + ", and was restarted (" + std::to_string(done_) + " of " +
        std::to_string(allowed_) + ")");
}

FrameProgram::FrameProgram(const Scenario& scenario, const SensorConfig& sensor,
                           const std::string& directory, OwnNodeSettings settings)
    : scenario_(scenario),
      node_(node_of(scenario, sensor)),
      settings_(settings_of(sensor, directory, std::move(settings))),
      begin_(begin_of(scenario, node_)),
      restarts_(scenario.network, node_.name, settings_) {}

Tick FrameProgram::tick_after(SimTime end) const {
  const Tick tick = (end.ns + scenario_.tick.ns - 1) / scenario_.tick.ns;
  return std::clamp<Tick>(tick, 0, scenario_.last_tick());
}

void FrameProgram::start(const Beginning& beginning) {
  const std::vector<std::string_view> more(beginning.more.begin(), beginning.more.end());
  program_ = settings_.start({scenario_, node_, settings_, beginning.begin, restarts_.any(), more});
}

}  // namespace dmise
