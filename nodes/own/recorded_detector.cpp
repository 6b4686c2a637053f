#include "nodes/own/recorded_detector.h"

#include <map>
#include <memory>
#include <utility>
#include <variant>
#include <vector>

#include "core/base/error.h"
#include "nodes/own/recorded_run.h"

namespace dmise {
namespace {

using RecordedFrames = std::map<std::uint32_t, std::vector<Detection>>;

std::string lacks(std::uint32_t frame, const std::string& sensor) {
  return "lacks frame " + std::to_string(frame) + " of sensor " + sensor;
}

}  // namespace

SourceFinder recorded_finder(const Scenario& scenario, const std::string& sensor,
                             std::uint32_t frames, const std::string& digest,
                             const std::string& path) {
  auto recorded = std::make_shared<RecordedFrames>();
  const auto hear = [&](const RecordedState& one) {
    if (!one.state) return true;
    const auto* found = std::get_if<DetectionSet>(one.state.get());
    if (!found) throw ConfigError("has something else than detections of sensor " + sensor);
    recorded->emplace(found->frame, found->detections);
    return true;
  };
  read_recorded_run(scenario, digest, path, {detection_prefix + sensor}, hear, [&] {
    for (std::uint32_t frame = 1; frame <= frames; ++frame)
      if (!recorded->contains(frame)) throw ConfigError(lacks(frame, sensor));
  });
  return [recorded, sensor, path](const CountImage&, const FrameHeader& header) {
    const auto found = recorded->find(header.frame);
    if (found == recorded->end()) throw Error(path + ": " + lacks(header.frame, sensor));
    return FoundInFrame(found->second);
  };
}

}  // namespace dmise
