#include "nodes/own/recorded_sensor.h"

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "nodes/own/recorded_run.h"

namespace dmise {
namespace {

std::string lacks(std::uint32_t frame, const std::string& sensor) {
  return "lacks frame " + std::to_string(frame) + " of sensor " + sensor;
}

/// What the recording has of each frame.
class RecordedFrames {
 public:
  RecordedFrames(const RecordedSensor& from, bool with_reports)
      : sensor_(from.sensor), path_(from.path), with_reports_(with_reports) {
    std::set<std::string> topics{detection_prefix + sensor_};
    if (with_reports) topics.insert(frame_prefix + sensor_);
    const auto hear = [this](const RecordedState& one) {
      if (one.state) keep(*one.state);
      return true;
    };
    read_recorded_run(from.scenario, from.digest, from.path, topics, hear, [&] {
      for (std::uint32_t frame = 1; frame <= from.frames; ++frame)
        if (!find(frame)) throw ConfigError(lacks(frame, sensor_));
    });
  }

  /// Throws `Error` for a frame that it lacks.
  ObservedBefore of(std::uint32_t frame) const {
    const Frame* found = find(frame);
    if (!found) throw Error(path_ + ": " + lacks(frame, sensor_));
    return {found->report.value_or(FrameReport{}), *found->detections};
  }

 private:
  struct Frame {
    std::optional<FrameReport> report;
    std::optional<std::vector<Detection>> detections;
  };

  void keep(const State& state) {
    if (const auto* report = std::get_if<FrameReport>(&state)) {
      frames_[report->frame].report = *report;
    } else if (const auto* found = std::get_if<DetectionSet>(&state)) {
      frames_[found->frame].detections = found->detections;
    } else {
      throw ConfigError("has something else than frames and detections of sensor " + sensor_);
    }
  }

  const Frame* find(std::uint32_t number) const {
    const auto found = frames_.find(number);
    if (found == frames_.end()) return nullptr;
    const Frame& frame = found->second;
    return frame.detections && (frame.report || !with_reports_) ? &frame : nullptr;
  }

  std::string sensor_, path_;
  bool with_reports_;
  std::map<std::uint32_t, Frame> frames_;
};

}  // namespace

SourceFinder recorded_finder(const RecordedSensor& recorded) {
  const auto frames = std::make_shared<const RecordedFrames>(recorded, false);
  return [frames](const CountImage&, const FrameHeader& header) {
    return FoundInFrame(frames->of(header.frame).detections);
  };
}

ExposureObserver recorded_observer(const RecordedSensor& recorded) {
  const auto frames = std::make_shared<const RecordedFrames>(recorded, true);
  return [frames](const ObserverExposure& exposure) {
    return ObservedInExposure(frames->of(exposure.frame));
  };
}

}  // namespace dmise
