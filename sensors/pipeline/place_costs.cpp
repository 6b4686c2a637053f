#include "sensors/pipeline/place_costs.h"

#include <algorithm>
#include <vector>

#include "core/effects/place_effects.h"
#include "sensors/pipeline/stopwatch.h"

namespace dmise {
namespace {

constexpr std::size_t sample_size = 64;
constexpr int repeats = 3;
constexpr const EffectFacts* of_stars[] = {&effect::proper_motion,      &effect::parallax,
                                           &effect::light_deflection,   &effect::annual_aberration,
                                           &effect::diurnal_aberration, &effect::refraction};
constexpr const EffectFacts* of_objects[] = {&effect::light_time, &effect::diurnal_aberration,
                                             &effect::refraction};

/// Least of some repeats: what the work itself takes.
template <class Work>
double seconds_of(const Work& work) {
  double least = 1e9;
  for (int i = 0; i < repeats; ++i) {
    double seconds = 0.0;
    {
      Stopwatch timing(seconds);
      work();
    }
    least = std::min(least, seconds);
  }
  return least;
}

/// `evaluate(places)` computes a sample of places; `scale` is how many such samples a frame has.
template <class Evaluate>
double add_costs(const View& view, std::span<const EffectFacts* const> effects, double scale,
                 const Evaluate& evaluate, EffectTimes& times) {
  const SimTime t = view.times().middle;
  const EffectSet& all = view.sensor().effects;
  const auto cost_of = [&](const EffectSet& set) {
    const ApparentPlaces places = view.places(t, set);
    return seconds_of([&] { evaluate(places); });
  };
  const double with_all_s = cost_of(all);
  double sum = 0.0;
  for (const EffectFacts* effect : effects) {
    if (!all.has(*effect) || (effect == &effect::refraction && !view.on_ground())) continue;
    EffectSet others = all;
    others.set(*effect, false);
    const double cost_s = std::max(0.0, with_all_s - cost_of(others)) * scale;
    times[*effect] += cost_s;
    sum += cost_s;
  }
  return sum;
}

}  // namespace

double add_place_costs(const View& view, const StarColumns& columns,
                       std::span<const std::uint32_t> stars, std::size_t evaluations,
                       EffectTimes& times) {
  if (stars.empty()) return 0.0;
  const auto sample = stars.first(std::min(sample_size, stars.size()));
  std::vector<Vec<Gcrs>> directions(sample.size());
  return add_costs(
      view, of_stars, double(evaluations) / double(sample.size()),
      [&](const ApparentPlaces& places) { places.stars(columns, sample, directions); }, times);
}

double add_object_place_costs(const View& view, std::span<const std::size_t> objects,
                              std::size_t evaluations, EffectTimes& times) {
  if (objects.empty()) return 0.0;
  const auto sample = objects.first(std::min(sample_size, objects.size()));
  std::vector<Motion> motions;
  for (const std::size_t object : sample)
    motions.push_back(view.world().motion(object, view.times().middle));
  std::vector<Vec<Gcrs>> directions(sample.size());
  return add_costs(
      view, of_objects, double(evaluations) / double(sample.size()),
      [&](const ApparentPlaces& places) {
        for (std::size_t i = 0; i < motions.size(); ++i)
          directions[i] =
              places.satellite(motions[i].position_m, motions[i].slope_m_per_s).direction;
      },
      times);
}

}  // namespace dmise
