#pragma once
#include <atomic>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "core/config/node_kinds.h"
#include "core/fusion/scheduler.h"
#include "core/sim/participant.h"
#include "core/time/clock.h"
#include "nodes/fusion/line_file.h"
#include "nodes/fusion/tracker.h"
#include "nodes/own/input_journal.h"
#include "nodes/own/own_node_run.h"

namespace dmise {

/// Returns a sensor as the scheduler needs it, with the angles within which its camera closes the
/// shutter; empty if the sensor is not cued.
std::optional<CuedSensor> cued_sensor(const SensorConfig& sensor);

/// Makes tracks of the detections of all sensors: publishes those that changed at a tick and writes
/// them to tracks.jsonl in the directory of the run. Gives tasks to sensors that are cued, and
/// writes them to tasks.jsonl.
class FusionEvaluator : public Evaluator {
 public:
  /// The scenario must have `fusion`. Throws `Error` if `directory` cannot be written. `settings`:
  /// of the program that makes the tracks, if the scenario names one.
  FusionEvaluator(const Scenario& scenario, Clock clock, const std::string& directory,
                  OwnNodeSettings settings = {});

  /// Takes what was said in a recorded run for what the scenario's tracker says; before a step.
  void replay(std::shared_ptr<Tracker> recorded) { tracker_ = std::move(recorded); }

  std::string name() const override { return fusion_node; }
  std::vector<std::string> produces() const override;
  /// The roster, and frames and detections of each sensor that detects.
  std::vector<std::string> consumes() const override;
  /// A lost sensor counts as one that sees nothing.
  bool needs(const std::string& topic) const override { return topic == roster_topic; }
  std::vector<Message> step(Tick tick, std::span<const Message> inputs) override;
  /// Repeats the earlier ticks from the journal.
  std::vector<Message> resume(Tick tick, std::span<const Message> past) override;
  std::uint64_t progress() const override { return progress_; }

 private:
  /// Makes the tracker, with the roster's objects that have elements, or those of `catalogue`, but
  /// for those of `not_in_catalogue`.
  void start_with(const ObjectRoster& roster);
  struct Found {
    TrackSet tracks;
    std::vector<Task> tasks;
    std::vector<KeptOrbit> orbits;
    std::vector<FoundBreakup> breakups;
  };
  /// Nothing after the stop.
  std::optional<Found> fuse(Tick tick, std::span<const Message> inputs);
  std::vector<Task> tasks_of(Tick tick, std::vector<CueWish>* wishes);
  void note_obstacles(Tick tick, const std::vector<CueWish>& wishes);
  void open_files(Tick tick);
  void write(const Found& found);

  Scenario scenario_;
  Clock clock_;
  std::string directory_;
  OwnNodeSettings settings_;
  std::shared_ptr<Tracker> tracker_;  // once the roster is known
  bool knows_roster_ = false;
  InputJournal journal_;
  std::vector<std::string> cued_;       // names of sensors, in the order of the scenario
  std::optional<Scheduler> scheduler_;  // if any is cued
  std::set<std::pair<std::string, std::string_view>> noted_;  // sensors and obstacles
  std::optional<LineFile> tracks_, tasks_, orbits_, breakups_;
  bool begun_ = false;
  std::atomic<std::uint64_t> progress_{0};
};

}  // namespace dmise
