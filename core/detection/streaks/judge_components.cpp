#include "core/detection/streaks/judge_components.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <iterator>

#include "core/detection/pixels/detection_limits.h"
#include "core/detection/streaks/compact_source.h"
#include "core/detection/streaks/long_streak.h"

namespace dmise {
namespace {

/// Axis ratio of the component's pixels, unweighted.
double elongation(const Component& c) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0, yy = 0;
  for (const Run& run : c.runs)
    for (int px = run.first_x; px <= run.last_x; ++px) {
      const double dx = px - c.peak_x, dy = run.y - c.peak_y;
      n += 1;
      x += dx;
      y += dy;
      xx += dx * dx;
      xy += dx * dy;
      yy += dy * dy;
    }
  xx = xx / n - x / n * x / n;
  xy = xy / n - x / n * y / n;
  yy = yy / n - y / n * y / n;
  const double mean = 0.5 * (xx + yy), half = std::hypot(0.5 * (xx - yy), xy);
  return std::sqrt((mean + half) / std::max(mean - half, 1.0 / 12));
}

/// Whether a component is longer than a star can be; if only slightly longer, it must also be
/// elongated, because the brightest stars are round.
bool is_long(const Scene& scene, const Component& c) {
  const double star_px = scene.star_trail(c.peak_x, c.peak_y).length_px;
  const double extent_px = std::hypot(c.max_x - c.min_x + 1, c.max_y - c.min_y + 1);
  const double limit_px = star_px + 12 * scene.sigma_px + 6;
  return extent_px > limit_px && (extent_px > limit_px + 20 || elongation(c) > 2);
}

/// Whether a component is no more than hidden stars and their wings: what rises above the seed's
/// SNR beside them touches them.
bool is_of_hidden_stars(const FilteredFrame& frame, const Component& c) {
  const auto touches_hidden = [&](int x, int y) {
    for (int py = std::max(0, y - 1); py <= std::min(frame.rows - 1, y + 1); ++py)
      for (int px = std::max(0, x - 1); px <= std::min(frame.columns - 1, x + 1); ++px)
        if (frame.row(py)[px] == 0) return true;
    return false;
  };
  // Brighter pixels are clipped, so that they are fewer steps where the scatter is large.
  const int seed = frame.steps_of(detection_limits::seed_snr, c.peak_x, c.peak_y);
  for (const Run& run : c.runs)
    for (int x = run.first_x; x <= run.last_x; ++x)
      if (frame.row(run.y)[x] >= seed && !touches_hidden(x, run.y)) return false;
  return true;
}

bool is_clipped(const Scene& scene, const Component& c) {
  return std::ranges::any_of(c.runs, [&](const Run& run) {
    for (int x = run.first_x; x <= run.last_x; ++x)
      if (scene.saturated(x, run.y)) return true;
    return false;
  });
}

/// Appends the compact sources in a component which is long because a source is on the rim of a
/// known star's wings.
void find_beside_stars(const Scene& scene, const FilteredFrame& frame, const Component& component,
                       std::vector<Source>& found) {
  for (const Component& part :
       parts_of(component, frame, detection_limits::connect_snr, detection_limits::seed_snr)) {
    if (is_long(scene, part) || is_clipped(scene, part) || is_of_hidden_stars(frame, part))
      continue;
    std::ranges::move(judge_compact(scene, part).sources, std::back_inserter(found));
  }
}

}  // namespace

Judged judge_components(const Scene& scene, const FilteredFrame& filtered,
                        const std::vector<Component>& components, Threads& threads) {
  Judged out;
  out.reach_px.resize(components.size(), int(std::ceil(2 * scene.sigma_px)));
  out.gave_source.resize(components.size());
  // Where faint stars scatter the sky, a component that is no source is hardly a part of one.
  const auto is_calm = [&](const Component& c) {
    return scene.known && filtered.cell_at(c.peak_x, c.peak_y).scatter < 1.2f;
  };
  std::vector<const Component*> longs, compacts;
  for (std::size_t i = 0; i < components.size(); ++i) {
    const Component& c = components[i];
    const bool lengthy = is_long(scene, c);
    if (!lengthy && scene.known && is_of_hidden_stars(filtered, c)) {
      ++out.star_like;
      out.reach_px[i] = 0;  // their wings are hidden
    } else {
      (lengthy ? longs : compacts).push_back(&c);
    }
  }
  std::ranges::stable_sort(longs, std::greater(), &Component::pixels);
  std::vector<CompactJudgement> found(compacts.size());
  threads.for_ranges(compacts.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) found[i] = judge_compact(scene, *compacts[i]);
  });
  for (const Component* component : longs) {
    const std::size_t before = out.sources.size();
    find_long_streaks(scene, *component, out.sources);
    if (scene.known && out.sources.size() == before)
      find_beside_stars(scene, filtered, *component, out.sources);
    const auto number = std::size_t(component - components.data());
    out.gave_source[number] = out.sources.size() > before;
    if (out.gave_source[number]) continue;
    ++out.star_like;
    if (is_calm(*component)) out.reach_px[number].reset();
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    const auto number = std::size_t(compacts[i] - components.data());
    out.gave_source[number] = !found[i].sources.empty();
    if (out.gave_source[number])
      std::ranges::move(found[i].sources, std::back_inserter(out.sources));
    else if (found[i].star_like)
      ++out.star_like;
    else if (is_calm(*compacts[i]))
      out.reach_px[number].reset();
  }
  return out;
}

}  // namespace dmise
