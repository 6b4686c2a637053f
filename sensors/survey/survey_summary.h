#pragma once
#include <optional>
#include <string>
#include <vector>

#include "sensors/survey/choose_sites.h"
#include "sensors/survey/sensor_survey.h"

namespace dmise {

/// Times between visits of an object: from the end of one to the start of the next. A visit is a
/// pass, of any sensor, in which the object is detected with a probability of a half or more;
/// passes less than `pass_gap_s` apart are one visit.
struct Revisits {
  std::size_t count = 0;
  double median_s = 0.0, most_of_90_s = 0.0;  // 0 without any
};

/// What a network expects of the objects of one shell in a night or in the run.
struct ShellSummary {
  std::size_t objects = 0;
  std::size_t covered = 0;  // with light in a frame
  double detected = 0.0;    // expected number of objects detected at least once
  double detections = 0.0;  // expected number
  std::size_t visits = 0;   // as above
  Revisits revisits;
};

/// What one sensor adds.
struct SensorTotals {
  std::size_t exposures = 0;
  double hours = 0.0;  // exposures times cadence
  std::size_t covered = 0;
  double detected = 0.0, detections = 0.0;
};

struct NightSummary {
  std::vector<ShellSummary> shells;  // as in `Shells`
  ShellSummary all;
  std::vector<SensorTotals> sensors;  // as in the surveys
};

struct SurveySummary {
  std::vector<NightSummary> nights;
  NightSummary run;
};

/// `cadence_s`: of each survey's sensor.
SurveySummary summarise_survey(const std::vector<SensorSurvey>& surveys, const Shells& shells,
                               const std::vector<double>& cadence_s, int nights);

/// Candidates for a choice of sites: what is at one place of the ground.
struct CandidateSite {
  std::string name;                  // name of its first sensor
  std::vector<std::size_t> sensors;  // indices
};
std::vector<CandidateSite> candidate_sites(const std::vector<SensorConfig>& sensors);

/// The misses of sites by the surveys of their sensors; sensors in orbit are there in any case.
SiteMisses misses_of(const std::vector<SensorSurvey>& surveys,
                     const std::vector<CandidateSite>& sites, std::size_t objects, int nights);

}  // namespace dmise
