#pragma once
#include <optional>
#include <string>
#include <vector>

#include "sensors/accuracy/rendered_check.h"
#include "sensors/survey/survey_summary.h"

namespace dmise {

/// A choice of sites with what the chosen network expects.
struct ChosenNetwork {
  SiteChoice choice;
  std::vector<CandidateSite> candidates;
  SurveySummary summary;  // chosen sites and what is in orbit
};

/// Results of a survey. The references must outlive it.
struct SurveyReport {
  const Scenario& scenario;
  const Clock& clock;
  const Shells& shells;
  const std::vector<SensorSurvey>& surveys;  // in the order of the scenario's sensors
  SurveySummary summary;
  double night_below_rad = 0.0;
  DetectionModel model;
  std::optional<ChosenNetwork> chosen;
  std::optional<RenderedCheck> check;
};

/// Tables for display.
std::string survey_text(const SurveyReport& report);

/// One JSON object: angles in degrees, times in UTC and seconds.
std::string survey_json(const SurveyReport& report);

}  // namespace dmise
