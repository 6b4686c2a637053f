#pragma once
#include <string>

#include "core/base/parallel.h"
#include "core/report/frame_choice.h"
#include "core/sky/stars/star_map.h"

namespace dmise {

/// A page of a run, without a server and without a network: its summary, pictures, curves, tables
/// and links to its files. `stars`: catalogue whose stars are marked; null: none are. Its bytes
/// depend on the directory's files alone. Names of sensors and objects are data in it, never markup
/// or script; what its script may do is limited by a Content-Security-Policy.
std::string run_report(const RunContents& run, const StarMap* stars, Threads& threads,
                       const ReportSettings& settings = {});

}  // namespace dmise
