#pragma once
#include <optional>
#include <string>

#include "sensors/survey/sensor_survey.h"

namespace dmise {

/// Writes exposures.csv, map.csv and passes.csv of one sensor into a directory. `head`: what the
/// survey depends on, one line. The second line of each has the digest of all three tables. Numbers
/// read back to the same bits.
void write_survey(const std::string& directory, const std::string& head, const SensorSurvey& survey,
                  const SurveyScene& scene, const Shells& shells);

/// Reads what `write_survey` wrote; nothing if the files are not there, have another head or are
/// damaged. `damaged`: there are files with this head, but not all three as they were written.
std::optional<SensorSurvey> read_survey(const std::string& directory, const std::string& head,
                                        const std::string& sensor, std::size_t objects,
                                        bool& damaged);

}  // namespace dmise
