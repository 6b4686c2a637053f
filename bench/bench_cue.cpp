#include "bench/bench_cue.h"

#include <algorithm>
#include <cmath>

#include "bench/figure.h"
#include "tests/support/cue_trial.h"

namespace dmise {
namespace {

constexpr int seeds = 100;
constexpr int within = 2;  // exposures

double median(std::vector<double> values) {
  if (values.empty()) return 0.0;
  std::ranges::sort(values);
  return values[values.size() / 2];
}

}  // namespace

int bench_cue(bool json) {
  int found_first = 0, with_cue = 0, tasks = 0, found = 0;
  std::vector<double> before_m, after_m, slew_s, wait_s;
  for (int seed = 1; seed <= seeds; ++seed) {
    bool first = true;
    for (const CueOutcome& cue : cue_trial({.seed = std::uint64_t(seed)})) {
      if (cue.exposures < within) continue;  // the run ended before
      const bool detected = cue.first_detection > 0 && cue.first_detection <= within;
      if (first) {
        ++with_cue;
        found_first += detected;
        wait_s.push_back((cue.on_target - cue.given).seconds());
      }
      first = false;
      ++tasks;
      found += detected;
      slew_s.push_back(cue.slew_s);
      if (cue.sigma_after_m > 0 && std::isfinite(cue.sigma_after_m)) {
        before_m.push_back(cue.sigma_before_m);
        after_m.push_back(cue.sigma_after_m);
      }
    }
  }
  print_figure({"cue_to_detection_share", double(found_first) / seeds, "1", "", 0, 0.95, false},
               json);
  print_figure({"cue_seeds_with_a_cue", double(with_cue), "1", "", 0, 0, false}, json);
  print_figure({"cue_tasks", double(tasks), "1", "", 0, 0, false}, json);
  print_figure({"cue_all_tasks_share", double(found) / std::max(1, tasks), "1", "", 0, 0.95, false},
               json);
  print_figure({"cue_slew_s", median(slew_s), "s", "", 0, 0, true}, json);
  print_figure({"cue_to_on_target_s", median(wait_s), "s", "", 0, 0, true}, json);
  print_figure({"cue_sigma_before_m", median(before_m), "m", "", 0, 0, true}, json);
  print_figure({"cue_sigma_after_m", median(after_m), "m", "", 0, 0, true}, json);
  return 0;
}

}  // namespace dmise
