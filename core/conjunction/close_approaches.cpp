#include "core/conjunction/close_approaches.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <tuple>

#include "core/fusion/catalogue_prediction.h"

namespace dmise {
namespace {

constexpr double step_s = 20.0;
// By which a path bends within a step, near the Earth, twice: 2 (g / 2) step^2.
constexpr double bend_m = 4000.0;
constexpr int iterations = 12;
constexpr double found_to_s = 1e-4;

/// Where the lines through both states come closest within a step, if that may be close enough.
bool may_be_close(const Vec<Gcrs>& r, const Vec<Gcrs>& v, double within_m) {
  const double speed2 = dot(v, v);
  const double t = speed2 > 0 ? std::clamp(-dot(r, v) / speed2, 0.0, step_s) : 0.0;
  return norm(r + v * t) < within_m + bend_m;
}

/// The closest approach between `from` and a step later, if there is one.
std::optional<CloseApproach> refined(const std::vector<MeanElements>& pair, const Clock& clock,
                                     const ApproachSearch& search, SimTime from) {
  CataloguePrediction both(pair, clock, search.beliefs);
  double t = 0.5 * step_s;
  for (int i = 0; i < iterations; ++i) {
    both.move(from + sim_seconds(t));
    if (!both.known(0) || !both.known(1)) return std::nullopt;
    const Encounter now{both.estimate(0), both.estimate(1), search.radius_m};
    const double step = to_closest_s(now);
    if (std::fabs(step) < found_to_s) {
      if (t < 0 || t >= step_s) return std::nullopt;  // another step finds it
      const double miss_m = norm(now.second.state.position_m - now.first.state.position_m);
      return miss_m < search.within_m ? std::optional(CloseApproach{0, 0, now}) : std::nullopt;
    }
    t += std::clamp(step, -step_s, step_s);
  }
  return std::nullopt;
}

}  // namespace

std::vector<CloseApproach> close_approaches(const std::vector<MeanElements>& elements,
                                            const Clock& clock, const ApproachSearch& search) {
  CataloguePrediction all(elements, clock, search.beliefs);
  std::vector<bool> wanted(elements.size(), false);
  for (const std::size_t i : search.of) wanted[i] = true;
  std::vector<CloseApproach> out;
  for (SimTime t; t < search.duration; t = t + sim_seconds(step_s)) {
    all.move(t);
    for (const std::size_t i : search.of) {
      if (!all.known(i)) continue;
      const Vec<Gcrs> r = all.position_m(i), v = all.velocity_m_per_s(i);
      for (std::size_t j = 0; j < elements.size(); ++j) {
        if (j == i || !all.known(j) || (wanted[j] && j < i)) continue;
        if (!may_be_close(all.position_m(j) - r, all.velocity_m_per_s(j) - v, search.within_m))
          continue;
        auto found = refined({elements[i], elements[j]}, clock, search, t);
        if (!found || search.duration < found->encounter.first.state.time) continue;
        found->first = i, found->second = j;
        out.push_back(std::move(*found));
      }
    }
  }
  std::ranges::sort(out, [](const CloseApproach& a, const CloseApproach& b) {
    return std::tuple(a.encounter.first.state.time, a.first, a.second) <
           std::tuple(b.encounter.first.state.time, b.first, b.second);
  });
  return out;
}

}  // namespace dmise
