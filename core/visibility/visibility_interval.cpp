#include "core/visibility/visibility_interval.h"

#include <algorithm>

namespace dmise {

std::vector<VisibilityInterval> intervals_of(std::vector<SeenRun> runs,
                                             std::vector<VisibilityInterval> crossings,
                                             const FineGrid& grid) {
  std::sort(runs.begin(), runs.end(), [](const SeenRun& a, const SeenRun& b) {
    return a.object != b.object ? a.object < b.object : a.first < b.first;
  });
  std::vector<VisibilityInterval> all = std::move(crossings);
  for (std::size_t k = 0; k < runs.size();) {
    SeenRun run = runs[k++];
    while (k < runs.size() && runs[k].object == run.object && runs[k].first == run.last + 1)
      run.last = runs[k++].last;
    const bool from_start = run.first == 0, to_end = run.last == grid.steps();
    all.push_back({run.object, grid.at(from_start ? run.first : run.first - 1), grid.at(run.first),
                   grid.at(run.last), grid.at(to_end ? run.last : run.last + 1), from_start,
                   to_end});
  }
  std::sort(all.begin(), all.end(), [](const VisibilityInterval& a, const VisibilityInterval& b) {
    return a.object != b.object ? a.object < b.object : a.in_first < b.in_first;
  });
  return all;
}

}  // namespace dmise
