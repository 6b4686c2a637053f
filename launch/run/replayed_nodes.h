#pragma once
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "core/config/scenario.h"
#include "core/detection/described_sources.h"
#include "core/sim/exposure_observer.h"
#include "core/sim/participant.h"

namespace dmise {

class Tracker;

/// What takes the place of programs of a run that is repeated with what they have said.
struct ReplayedNodes {
  std::map<std::string, std::unique_ptr<Participant>> actors;  // by node
  std::map<std::string, SourceFinder> finders;                 // by sensor
  std::map<std::string, ExposureObserver> observers;           // by sensor
  std::shared_ptr<Tracker> tracker;
};

/// Files by the nodes of the user's that they replay, of "NODE=FILE" each. Throws `ConfigError`.
std::map<std::string, std::string> recordings_of(const std::vector<std::string>& replayed,
                                                 const Scenario& scenario);

/// Reads the recordings. `digest`: of the scenario. Throws `ConfigError` for one that is not whole
/// or of another run.
ReplayedNodes replayed_nodes(const std::map<std::string, std::string>& recordings,
                             const Scenario& scenario, const std::string& digest);

}  // namespace dmise
