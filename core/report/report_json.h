#pragma once
#include <string>

#include "core/base/parallel.h"
#include "core/report/frame_choice.h"
#include "core/sky/stars/star_map.h"

namespace dmise {

/// What the page of a run shows, as JSON: summary, sensors, frames with the pixels of some, truth,
/// detections, score, plan, tracks, clock and files. Numbers that are not known or not finite are
/// null.
std::string report_json(const RunContents& run, const StarMap* stars, Threads& threads,
                        const ReportSettings& settings);

}  // namespace dmise
