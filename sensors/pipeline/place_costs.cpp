#include "sensors/pipeline/place_costs.h"

#include <algorithm>
#include <vector>

#include "sensors/pipeline/stopwatch.h"

namespace dmise {
namespace {

constexpr std::size_t sample_size = 256;
constexpr int repeats = 3;
constexpr Effect corrections[] = {Effect::proper_motion,      Effect::parallax,
                                  Effect::light_deflection,   Effect::annual_aberration,
                                  Effect::diurnal_aberration, Effect::refraction};

double seconds_of(const ApparentPlaces& places, const StarColumns& columns,
                  std::span<const std::uint32_t> sample, std::span<Vec<Gcrs>> directions) {
  double least = 1e9;
  for (int i = 0; i < repeats; ++i) {
    double seconds = 0.0;
    {
      Stopwatch timing(seconds);
      places.stars(columns, sample, directions);
    }
    least = std::min(least, seconds);
  }
  return least;
}

}  // namespace

double add_place_costs(const View& view, const StarColumns& columns,
                       std::span<const std::uint32_t> stars, std::size_t evaluations,
                       EffectTimes& times) {
  if (stars.empty()) return 0.0;
  const auto sample = stars.first(std::min(sample_size, stars.size()));
  std::vector<Vec<Gcrs>> directions(sample.size());
  const SimTime t = view.times().middle;
  const EffectSet& all = view.sensor().effects;
  const double with_all_s = seconds_of(view.places(t, all), columns, sample, directions);
  const double scale = double(evaluations) / double(sample.size());
  double sum = 0.0;
  for (const Effect effect : corrections) {
    if (!all.has(effect) || (effect == Effect::refraction && !view.on_ground())) continue;
    EffectSet others = all;
    others.set(effect, false);
    const double without_s = seconds_of(view.places(t, others), columns, sample, directions);
    const double cost_s = std::max(0.0, with_all_s - without_s) * scale;
    times[effect] += cost_s;
    sum += cost_s;
  }
  return sum;
}

}  // namespace dmise
