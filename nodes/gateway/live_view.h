#pragma once
#include <map>
#include <optional>
#include <set>
#include <string>

#include "core/frames/earth_orientation.h"
#include "core/sim/message.h"
#include "nodes/gateway/latest_messages.h"
#include "nodes/gateway/view_history.h"
#include "nodes/runtime/observability/status.h"
#include "nodes/runtime/observability/tick_rate.h"

namespace dmise {

// Layout of a message with objects, little endian:
//   0   4 bytes   "DMOB"
//   4   uint32    number of objects, in the order of the roster
//   8   float64   simulation time [s]
//   16  float64   UTC of that time [ms since 1970]
//   24  float32   3 per object: position in ITRS [km]; 0 0 0 of an object without a state
inline constexpr std::size_t objects_header_bytes = 24;

/// Encodes positions for viewers. `utc_ms`: of `states.time`.
std::string encode_objects(const ObjectStates& states, const EarthOrientation& earth,
                           double utc_ms);

/// Makes the messages to viewers from what is published in a run. Has no socket; used from one
/// thread. Its input has passed the checks of nodes/wire.
class LiveView {
 public:
  /// Without `takes_truth` truth is ignored, so that none can reach a viewer.
  LiveView(LatestMessages& latest, ViewHistory& history, bool takes_truth = false)
      : latest_(latest), history_(history), takes_truth_(takes_truth) {}

  /// Takes the state of a message.
  void take(const State& state);
  /// Takes the state of the run; that of another run replaces all that was taken before. `gaps`:
  /// messages of each publisher that were missed.
  void take(const RunStatus& status, const std::map<std::string, std::uint64_t>& gaps);
  /// Sends viewers a notice: something that they asked for failed.
  void notify(const std::string& text);
  /// Encodes what has changed since the last call. Call some ten times a second.
  void publish();

  /// Whether objects have names. The roster is published once; a late observer must request it.
  bool has_roster() const { return has_roster_; }

 private:
  struct SensorView {
    FrameReport report;
    std::vector<Vec<Itrs>> field;  // unit directions of the border, from the first pixel on
    Vec<Itrs> position_m, boresight;
    std::vector<Detection> detections;  // in the last frame
    std::uint32_t detections_frame = 0;
    std::uint64_t detections_total = 0;
    std::vector<Truth> truths;  // objects in the last frame
    std::uint32_t truths_frame = 0;
    std::optional<Task> task;
  };

  void take(const ObjectRoster& roster);
  void take(const ObjectStates& states);
  void take(const EnvironmentState& environment) { earth_ = environment.earth; }
  void take(const SiteState&) {}
  void take(const FrameReport& report);
  void take(const DetectionSet& set);
  void take(const TruthSet& set);
  void take(const TrackSet& set);
  void take(const TaskSet& set);

  void forget_run();
  void encode_run(const RunStatus& status);
  std::string sensors_json() const;
  std::string detections_json() const;
  std::string tracks_json() const;
  std::string tasks_json() const;
  std::string truth_json() const;
  double utc_ms(double time_s) const;
  void remember();

  LatestMessages& latest_;
  ViewHistory& history_;
  bool takes_truth_;
  std::optional<EarthOrientation> earth_;
  std::optional<double> start_utc_ms_;
  std::optional<RunStatus> status_;
  std::map<std::string, SensorView> sensors_;
  std::map<std::uint32_t, Track> tracks_;
  std::set<MessageSlot> changed_;
  bool has_roster_ = false;
  double time_s_ = 0.0;  // simulation time of the latest state taken
  std::uint64_t notices_ = 0;
  std::map<std::string, TickRate> progress_;  // "": of the clock
};

}  // namespace dmise
