#pragma once
#include <functional>
#include <string>

#include "core/config/scenario.h"
#include "nodes/own/own_program.h"

namespace dmise {

/// How the program of a node is run, whatever it is for.
struct OwnNodeSettings {
  std::string log_path;      // of the program's output; empty: stderr of this process
  std::string error_prefix;  // of errors; empty where the run names the node
  std::function<void(const std::string&)> note = [](const std::string&) {};  // hears lines
  const Event* stop = nullptr;
};

/// What a program is told as it begins, without its objects.
v1::OwnNodeBegin begin_of(const Scenario& scenario, const OwnNode& node);

ProgramSettings program_settings(const Scenario& scenario, const OwnNode& node,
                                 const OwnNodeSettings& settings);

/// Counts how often a program is started again, up to what the scenario allows.
class OwnRestarts {
 public:
  OwnRestarts(const NetworkConfig& network, std::string node, const OwnNodeSettings& settings);

  /// Notes that the program is started again after it was lost at `place` ("tick 7"). Throws
  /// `Error` if it may not be.
  void after(const ProgramLost& lost, const std::string& place);
  bool any() const { return done_ > 0; }

 private:
  OnSilentNode policy_;
  int allowed_;
  std::string node_, error_prefix_;
  std::function<void(const std::string&)> note_;
  int done_ = 0;
};

}  // namespace dmise
