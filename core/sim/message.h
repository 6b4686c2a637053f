#pragma once
#include <memory>
#include <string>
#include <variant>
#include <vector>

#include "core/products/detection.h"
#include "core/products/frame_report.h"
#include "core/products/task.h"
#include "core/products/track.h"
#include "core/products/truth.h"
#include "core/sim/state.h"

namespace dmise {

/// Detections of one sensor in one frame; `detections` may be empty.
struct DetectionSet {
  std::string sensor;
  std::uint32_t frame = 0;
  std::vector<Detection> detections;

  bool operator==(const DetectionSet&) const = default;
};

struct TruthSet {
  std::string sensor;
  std::uint32_t frame = 0;
  std::vector<Truth> truths;

  bool operator==(const TruthSet&) const = default;
};

/// Tracks that changed at one tick, by id: what began, took a detection or ended.
struct TrackSet {
  Tick tick = 0;
  SimTime time;
  std::string node;
  std::uint32_t live = 0;          // tracks that have not ended
  std::uint32_t unassociated = 0;  // detections of the tick that no track took
  std::vector<Track> tracks;

  bool operator==(const TrackSet&) const = default;
};

/// Tasks that a node gives a sensor at one tick, by id.
struct TaskSet {
  Tick tick = 0;
  SimTime time;
  std::string node;
  std::string sensor;
  std::vector<Task> tasks;

  bool operator==(const TaskSet&) const = default;
};

/// Everything that actors and evaluators exchange. To add a state: list it here, give it a message
/// in proto/ and a pair of functions in nodes/wire.
using State = std::variant<ObjectRoster, ObjectStates, EnvironmentState, FrameReport, DetectionSet,
                           TruthSet, SiteState, TrackSet, TaskSet>;

/// One state, published on a topic for a tick. A topic may carry none, one or several per tick.
struct Message {
  std::string topic;
  Tick tick = 0;
  std::shared_ptr<const State> state;
};

/// Whether a message holds for the whole run, so that late subscribers need it as well.
inline bool is_retained(const State& state) { return std::holds_alternative<ObjectRoster>(state); }

// Topics. A sensor's own topics are `prefix + sensor name`.
inline constexpr const char* roster_topic = "state/roster";    // at tick 0
inline constexpr const char* objects_topic = "state/objects";  // roster (tick 0), then states
inline constexpr const char* actor_prefix = "state/actor/";    // states of a node's own objects
inline constexpr const char* environment_topic = "env/common";
inline constexpr const char* site_prefix = "env/site/";  // the atmosphere above a ground sensor
inline constexpr const char* frame_prefix = "frame/";
inline constexpr const char* detection_prefix = "detection/";
inline constexpr const char* track_prefix = "track/";  // and the name of the node
inline constexpr const char* task_prefix = "task/";    // and the sensor that is to observe
inline constexpr const char* truth_prefix = "truth/";  // own endpoint, own security domain

}  // namespace dmise
