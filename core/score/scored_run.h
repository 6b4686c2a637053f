#pragma once
#include <string>

#include "core/products/frame_report.h"
#include "core/products/truth.h"
#include "core/run/run_record.h"
#include "core/score/score_input.h"

namespace dmise {

/// Reads run.json, frames.jsonl, truth.jsonl and detections.jsonl of a run's directory. Throws
/// `ConfigError` "FILE:LINE: KEY: reason" for a file that is missing or invalid, and for a second
/// line of the same frame, truth or detection. A last line without its end was interrupted and is
/// left out.
ScoreInput read_run(const std::string& directory, const ReadProgress& progress);

/// The source that a truth describes.
TrueSource source_of(const Truth& truth);

/// The frame of a report, taken by a sensor's camera.
ScoredFrame frame_of(const FrameReport& report, const RunSensor& sensor);

}  // namespace dmise
