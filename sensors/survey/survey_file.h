#pragma once
#include <optional>
#include <string>

#include "sensors/survey/sensor_survey.h"

namespace dmise {

/// Writes exposures.csv, map.csv and passes.csv of one sensor into a directory, the last at the
/// end: a survey that is there is whole. `head`: what the survey depends on, one line. Numbers read
/// back to the same bits.
void write_survey(const std::string& directory, const std::string& head, const SensorSurvey& survey,
                  const SurveyScene& scene, const Shells& shells);

/// Reads what `write_survey` wrote; nothing if the files are not there, have another head or are
/// damaged.
std::optional<SensorSurvey> read_survey(const std::string& directory, const std::string& head,
                                        const std::string& sensor, std::size_t objects);

}  // namespace dmise
