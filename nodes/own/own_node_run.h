#pragma once
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/config/scenario.h"
#include "nodes/own/own_model.h"

namespace dmise {

class Event;
struct ModelBeginning;

/// Starts the model of a node: `start_program` (nodes/own/own_program.h), or one in this process.
using ModelStarter = std::function<std::unique_ptr<OwnModel>(const ModelBeginning&)>;

/// How the model of a node is run, whatever it is for.
struct OwnNodeSettings {
  ModelStarter start;
  std::string log_path = {};      // where the program's output goes; empty: stderr of this process
  std::string journal_path = {};  // keeps what an actor hears, if it consumes topics
  std::string error_prefix = {};  // begins each error; empty where the run names the node
  std::function<void(const std::string&)> note = [](const std::string&) {};  // hears lines
  const Event* stop = nullptr;
};

/// What a model is started with.
struct ModelBeginning {
  const Scenario& scenario;
  const OwnNode& node;
  const OwnNodeSettings& settings;
  const v1::OwnNodeBegin& begin;  // what it is told
  bool again = false;             // it has been started before
  OwnModel::Frames more = {};     // frames after `begin`
};

/// What a program is told as it begins, without its objects.
v1::OwnNodeBegin begin_of(const Scenario& scenario, const OwnNode& node);

/// Adds what a program is told of a sensor: where it is, and when it observes.
void describe_sensor(const SensorConfig& sensor, v1::OwnNodeSensor& told);

/// What a program has said, call by call: one that was started again continues from its last
/// checkpoint and must say the same.
class OwnRecord {
 public:
  /// The next call of the program.
  Tick next() const { return next_; }
  /// Whether a checkpoint is asked for with a call.
  static bool wants_checkpoint(Tick call);
  /// Goes back to where a program that is started continues, and tells it so.
  void continue_at(v1::OwnNodeBegin& begin);
  /// `what`: it said. Throws `Error` if it is not what was said before.
  void add(std::uint64_t digest, std::optional<std::string> checkpoint, const char* what);

 private:
  Tick next_ = 0;
  std::vector<std::uint64_t> digests_;  // by call
  Tick checkpoint_at_ = 0;              // the call after it
  std::optional<std::string> checkpoint_;
};

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

/// A program that is asked for one frame after another by the process of a sensor. It is started at
/// the first. Under `on_silent_node: restart` one that dies or is silent is started again, and
/// asked for the same frame.
class FrameProgram {
 public:
  /// `scenario` must outlive it. The log is that of the node and the sensor, below `directory`.
  FrameProgram(const Scenario& scenario, const SensorConfig& sensor, const std::string& directory,
               OwnNodeSettings settings);

  /// What a program is told as it begins, with the frames after that.
  struct Beginning {
    v1::OwnNodeBegin begin;
    std::vector<std::string> more = {};
  };
  const v1::OwnNodeBegin& begin() const { return begin_; }
  /// The first tick that is not before the end of an exposure.
  Tick tick_after(SimTime end) const;

  /// Returns what `answer_of` has from the program. Throws `Error` with node, frame and tick.
  template <class BeginningOf, class AnswerOf>
  auto ask(std::uint32_t frame, SimTime end, const BeginningOf& beginning_of,
           const AnswerOf& answer_of) {
    const std::string place =
        "frame " + std::to_string(frame) + " (tick " + std::to_string(tick_after(end)) + ")";
    while (true) {
      try {
        if (!program_) start(beginning_of());
        return answer_of(*program_);
      } catch (const ProgramLost& lost) {
        program_.reset();
        restarts_.after(lost, place);
      } catch (const Error& error) {
        throw Error(settings_.error_prefix + place + ": " + error.what());
      }
    }
  }

 private:
  void start(const Beginning& beginning);

  const Scenario& scenario_;
  OwnNode node_;
  OwnNodeSettings settings_;
  v1::OwnNodeBegin begin_;
  std::unique_ptr<OwnModel> program_;
  OwnRestarts restarts_;
};

}  // namespace dmise
