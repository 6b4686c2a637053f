#pragma once
#include <string>

#include "core/base/parallel.h"
#include "core/score/score_input.h"

namespace dmise {

/// Reads run.json, frames.jsonl, truth.jsonl and detections.jsonl of a run's directory. Throws
/// `ConfigError` "FILE:LINE: KEY: reason" for a file that is missing or invalid, and for two lines
/// of one thing. A last line without its end was interrupted and is left out.
ScoreInput read_run(const std::string& directory);

/// The frame of a report (`FileDetections::report`, a line of frames.jsonl), without what the
/// report does not say: its size and, unless it does, its PSF.
class JsonRecord;
ScoredFrame frame_of(const JsonRecord& report);

}  // namespace dmise
