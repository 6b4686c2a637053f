#include "launch/run/node_makers.h"

#include <algorithm>
#include <utility>

#include "core/base/error.h"
#include "core/config/make_clock.h"
#include "core/config/node_kinds.h"
#include "core/run/run_files.h"
#include "launch/run/make_fusion.h"
#include "nodes/environment/environment_actor.h"
#include "nodes/own/input_journal.h"
#include "nodes/own/own_actor.h"
#include "nodes/own/own_detector.h"
#include "nodes/own/own_program.h"
#include "nodes/own/own_sensor.h"
#include "nodes/runtime/process/event.h"
#include "orbit-node/orbit_actor.h"
#include "sensors/frame/make_sensor.h"
#include "sensors/positions/position_files.h"
#include "sensors/positions/positions_evaluator.h"
#include "sensors/scene/frame_times.h"

namespace dmise {
namespace {

std::unique_ptr<Participant> make_orbit(const std::string&, NodeParts& parts) {
  auto orbit = std::make_unique<OrbitActor>(parts.scenario, make_clock(parts.scenario),
                                            std::move(parts.scene.population), parts.threads);
  orbit->on_absence(parts.note);
  return orbit;
}

std::unique_ptr<Participant> make_environment(const std::string&, NodeParts& parts) {
  return std::make_unique<EnvironmentActor>(parts.scenario, make_clock(parts.scenario));
}

std::unique_ptr<Participant> make_own_node(const std::string& name, NodeParts& parts) {
  const auto& nodes = parts.scenario.own_nodes;
  const OwnNode& node = *std::ranges::find(nodes, name, &OwnNode::name);
  auto& actors = parts.replayed.actors;
  if (const auto found = actors.find(name); found != actors.end()) return std::move(found->second);
  return std::make_unique<OwnActor>(
      parts.scenario, node, make_clock(parts.scenario),
      OwnNodeSettings{.start = start_program,
                      .log_path = parts.directory + "/logs/" + name + ".log",
                      .journal_path = input_journal_path(parts.directory, name),
                      .error_prefix = name + ": ",
                      .note = parts.note,
                      .stop = &stop_signal()});
}

std::unique_ptr<Participant> make_one_sensor(const std::string& node, NodeParts& parts) {
  const OwnNodeSettings settings{.start = start_program,
                                 .error_prefix = node + ": ",
                                 .note = parts.note,
                                 .stop = &stop_signal()};
  SourceFinder finder = std::move(parts.replayed.finders[node]);
  if (!finder) finder = own_finder(parts.scenario, node, parts.directory, settings);
  ExposureObserver observer = std::move(parts.replayed.observers[node]);
  if (!observer) observer = own_observer(parts.scenario, node, parts.directory, settings);
  return make_sensor(parts.scenario, node, parts.digest, parts.directory, parts.scene.stars,
                     parts.threads, std::move(finder), std::move(observer));
}

std::unique_ptr<Participant> make_positions(const std::string&, NodeParts& parts) {
  return std::make_unique<PositionsEvaluator>(parts.scenario, make_clock(parts.scenario),
                                              parts.directory);
}

std::unique_ptr<Participant> make_fusion_node(const std::string& name, NodeParts& parts) {
  return make_fusion(parts.scenario, make_clock(parts.scenario), parts.directory,
                     {.start = start_program,
                      .error_prefix = name + ": ",
                      .note = parts.note,
                      .stop = &stop_signal()},
                     std::move(parts.replayed.tracker));
}

std::optional<Tick> no_products(const std::string&, const Scenario&, const std::string&) {
  return std::nullopt;
}

std::optional<Tick> unfinished_frame(const std::string& node, const Scenario& scenario,
                                     const std::string& directory) {
  const SensorConfig& sensor = sensor_named(scenario, node);
  if (std::holds_alternative<PointCued>(sensor.pointing)) {  // makes no frame of most exposures
    const Tick next = CueJournal::ticks_done(directory + "/" + node);
    return next > scenario.last_tick() ? std::nullopt : std::optional(next);
  }
  const std::uint32_t frames = frames_finished(node, directory);
  if (frames >= frames_within(sensor, scenario.duration)) return std::nullopt;
  const SimTime end = exposure_span(sensor, frames + 1).end;
  return tick_needed(scenario.interpolation, end, scenario.tick, scenario.last_tick());
}

/// The last tick in the files may be incomplete.
std::optional<Tick> unfinished_positions(const std::string&, const Scenario&,
                                         const std::string& directory) {
  return std::max<Tick>(0, last_tick_written(directory));
}

/// The first tick that is not in the journal of a node.
std::optional<Tick> unfinished_journal(const std::string& node, const Scenario& scenario,
                                       const std::string& directory) {
  const Tick next = InputJournal::ticks_written(input_journal_path(directory, node));
  return next > scenario.last_tick() ? std::nullopt : std::optional(next);
}

std::optional<Tick> unfinished_own_node(const std::string& node, const Scenario& scenario,
                                        const std::string& directory) {
  const bool has_journal = writes_files(*kind_of_node(node, scenario), node, scenario);
  return has_journal ? unfinished_journal(node, scenario, directory) : std::nullopt;
}

constexpr NodeMaker makers[] = {
    {orbit_node, make_orbit, no_products},
    {environment_node, make_environment, no_products},
    {any_own_node, make_own_node, unfinished_own_node},
    {any_sensor, make_one_sensor, unfinished_frame},
    {positions_node, make_positions, unfinished_positions},
    {fusion_node, make_fusion_node, unfinished_journal},
};

}  // namespace

const NodeMaker& maker_of(const NodeKind& kind) {
  for (const NodeMaker& maker : makers)
    if (std::string(maker.kind) == kind.name) return maker;
  throw Error(std::string(kind.name) + ": has no maker");
}

std::uint32_t frames_finished(const std::string& sensor, const std::string& directory) {
  return std::uint32_t(count_lines(path_in(directory + "/" + sensor, run_file::frames)));
}

}  // namespace dmise
