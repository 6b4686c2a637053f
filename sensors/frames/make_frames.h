#pragma once
#include <functional>
#include <string>
#include <vector>

#include "nodes/own/own_node_run.h"
#include "sensors/frame/frame_pipeline.h"
#include "sensors/frames/load_scene.h"

namespace dmise {

/// A sensor whose frames are made in this process, without files, and who takes them.
struct FrameTap {
  std::string sensor;
  /// Called once, before the first frame; at first no plane but the counts is made.
  std::function<void(PipelineSettings&)> set_up;
  /// Called with each frame in order; may move from it what it keeps.
  std::function<void(FrameProducts&)> made;
};

/// Makes all frames of the sensors of `taps`, as a run of the scenario does; `digest` goes into
/// their headers. `models`: how those of the scenario's nodes are run that move or turn objects, or
/// detect. Throws `ConfigError` for a sensor that is cued, which needs the detections of all
/// sensors, and what a run throws.
void make_frames(Scenario scenario, ScenarioInputs scene, const std::string& digest,
                 const std::vector<FrameTap>& taps, Threads& threads,
                 const OwnNodeSettings& models = {});

}  // namespace dmise
