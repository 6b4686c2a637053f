#pragma once

namespace CLI {
class App;
}

namespace dmise {

/// Time of a night's survey and of a choice of sites, and predicted detections against rendered
/// frames.
int bench_survey(bool json);
void add_survey_options(CLI::App& app);

}  // namespace dmise
