#pragma once
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "core/config/node_kinds.h"
#include "core/sim/participant.h"
#include "launch/run_directory.h"
#include "launch/scenario_outlook.h"

namespace dmise {

/// What the participants of a run in one process are made of.
struct NodeParts {
  const Scenario& scenario;
  Scene& scene;  // what it holds is moved into whoever needs it alone
  std::string digest, directory;
  Threads& threads;
  std::function<void(const std::string&)> note;  // called for each line to be shown
};

/// What `dmise run` knows of a kind of node beyond its row in core/config/node_kinds.h.
struct NodeMaker {
  const char* kind;
  std::unique_ptr<Participant> (*make)(const std::string& node, NodeParts&);
  /// The first tick of which a node's products are not whole; nothing if all are.
  std::optional<Tick> (*unfinished)(const std::string& node, const Scenario&,
                                    const std::string& directory);
};

/// Throws `Error` for a kind that has no maker.
const NodeMaker& maker_of(const NodeKind& kind);

/// Frames of a sensor from the first on whose line is whole: it is written last of all.
std::uint32_t frames_finished(const std::string& sensor, const std::string& directory);

}  // namespace dmise
