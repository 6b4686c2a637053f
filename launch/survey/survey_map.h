#pragma once
#include <string>
#include <vector>

#include "sensors/survey/survey_summary.h"

namespace dmise {

/// A place on the ground, marked on the map.
struct MapMark {
  double latitude_deg = 0.0, longitude_deg = 0.0;
};

/// Map of a survey: for every shell with light in a frame, the expected detections under the
/// objects, in cells of 5 deg, and the sites.
struct SurveyMap {
  std::string title, subtitle;
  std::vector<Shell> shells;
  std::vector<ShellSummary> summaries;  // one per shell
  MapCells cells;                       // all sensors together
  std::vector<MapMark> sites;
};

std::string map_svg(const SurveyMap& map);

}  // namespace dmise
