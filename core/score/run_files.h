#pragma once
#include <optional>
#include <string>

#include "core/frames/geodesy.h"
#include "core/products/truth.h"
#include "core/score/score_input.h"

namespace dmise {

/// Reads run.json, frames.jsonl, truth.jsonl and detections.jsonl of a run's directory. Throws
/// `ConfigError` "FILE:LINE: KEY: reason" for a file that is missing or invalid, and for a second
/// line of the same frame, truth or detection. A last line without its end was interrupted and is
/// left out.
ScoreInput read_run(const std::string& directory, const ReadProgress& progress);

/// The source that a line of truth.jsonl describes.
TrueSource source_of(const Truth& truth);

class JsonRecord;
/// The frame of a report (`FileDetections::report`, a line of frames.jsonl), without its size and,
/// unless the report states it, its PSF.
ScoredFrame frame_of(const JsonRecord& report);
/// Size and PSF of a frame of a sensor, as run.json's scenario describes it; none without a camera.
ScoredFrame camera_of(const JsonRecord& sensor);
/// Where such a sensor is, over the scenario's ellipsoid, which is not set; none in orbit.
std::optional<Site> site_of(const JsonRecord& sensor);

}  // namespace dmise
