#pragma once

namespace CLI {
class App;
}

namespace dmise {

/// Time of a night's survey and of a choice of sites, and predicted detections against rendered
/// frames.
int bench_survey(bool json);
void add_survey_options(CLI::App& app);

/// Its first part alone: the night's time, and what is detected.
void bench_survey_night(bool json);

}  // namespace dmise
