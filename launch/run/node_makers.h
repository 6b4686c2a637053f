#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/config/node_kinds.h"
#include "core/sim/participant.h"
#include "launch/run/replayed_nodes.h"
#include "launch/run/run_directory.h"
#include "launch/run/scenario_forecast.h"

namespace dmise {

/// Inputs for the participants of a run in one process.
struct NodeParts {
  const Scenario& scenario;
  ScenarioInputs& scene;  // parts with a single user are moved out
  std::string digest, directory;
  Threads& threads;
  std::function<void(const std::string&)> note;  // prints a line
  ReplayedNodes replayed = {};                   // moved out
};

/// Properties of a kind of node for `dmise run`, in addition to its row in
/// core/config/node_kinds.h.
struct NodeMaker {
  const char* kind;
  std::unique_ptr<Participant> (*make)(const std::string& node, NodeParts&);
  /// The first tick with incomplete products of a node; empty if all are complete.
  std::optional<Tick> (*unfinished)(const std::string& node, const Scenario&,
                                    const std::string& directory);
};

/// Throws `Error` for a kind without a maker.
const NodeMaker& maker_of(const NodeKind& kind);

/// Number of frames of a sensor that are complete: their line in frames.jsonl is written last.
std::uint32_t frames_finished(const std::string& sensor, const std::string& directory);

}  // namespace dmise
