#pragma once
#include <string>

#include "core/config/scenario.h"

namespace dmise {

/// Draws how well the tracks of a run are known, against time, from its tracks.jsonl and
/// tasks.jsonl to tracks.svg: those in no catalogue and, of the others, those that were cued most;
/// bands are where a sensor was cued to the first kind, or to the track that was cued most. Returns
/// whether there was anything to draw.
bool write_tracks_figure(const Scenario& scenario, const std::string& directory);

}  // namespace dmise
