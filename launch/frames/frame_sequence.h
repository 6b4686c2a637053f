#pragma once
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "core/ingest/any_frame.h"
#include "core/sequences/sequence_frame.h"

namespace dmise {

/// A frame of a file as one of a sequence, without the pixels that its camera knows to be hot.
SequenceFrame frame_of_sequence(const std::string& path, const Frame& frame);

/// Prints what moves over frames, a line of JSON each. `max_rate_rad_per_s`: 0 for the default.
void print_sequence(std::vector<SequenceFrame> frames, double max_rate_rad_per_s, Threads& threads);

}  // namespace dmise
