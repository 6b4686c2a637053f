#pragma once
#include <cstddef>
#include <iterator>
#include <string>
#include <vector>

#include "sensors/survey/shells.h"

namespace dmise {

/// Options of `dmise survey`.
struct SurveyCommand {
  std::string scenario, out = "out/survey";
  std::string optimise;  // "sites=K"; empty: no choice of sites
  double night_deg = -6.0;
  std::vector<double> shells_km{std::begin(usual_shell_limits_km), std::end(usual_shell_limits_km)};
  std::size_t check = 0, fit = 0;  // frames that are rendered
  bool json = false;
  int threads = 2;
};

/// Surveys the scenario, or completes its survey in `out`; writes the products and prints tables or
/// JSON. Throws `ConfigError` for errors in the scenario or the options, before a directory is
/// made.
void run_survey(const SurveyCommand& command);

}  // namespace dmise
