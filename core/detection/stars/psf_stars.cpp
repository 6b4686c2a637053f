#include "core/detection/stars/psf_stars.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/detection/source/source_fit.h"

namespace dmise {
namespace {

constexpr float bright_peak_snr = 20.0f, min_peak_snr = 10.0f;
constexpr std::size_t enough_bright = 30;  // so many make fainter ones needless
constexpr int zones_across = 6, zones_down = 4;
constexpr double max_extent_px = 400.0;  // a star with a longer trail is rarely alone
constexpr double max_sigmas = 30.0;      // reach of a star's light by the header's Gaussian

/// Whether a component may be a whole star by its rectangle.
bool has_extent_of_star(const Scene& scene, const Component& c) {
  if (c.peak_snr < min_peak_snr) return false;
  const int width = c.max_x - c.min_x + 1, height = c.max_y - c.min_y + 1;
  if (width > max_extent_px || height > max_extent_px) return false;
  if (c.min_x < 3 || c.min_y < 3 || c.max_x > scene.counts.columns - 4 ||
      c.max_y > scene.counts.rows - 4)
    return false;
  const Trail star = scene.star_trail(c.peak_x, c.peak_y);
  const double light_px = max_sigmas * scene.sigma_px + 6;
  return width < star.length_px * std::abs(std::cos(star.angle_rad)) + light_px &&
         height < star.length_px * std::abs(std::sin(star.angle_rad)) + light_px;
}

bool is_brighter(const Component* a, const Component* b) {
  if (a->peak_snr != b->peak_snr) return a->peak_snr > b->peak_snr;
  return a->peak_y != b->peak_y ? a->peak_y < b->peak_y : a->peak_x < b->peak_x;
}

}  // namespace

std::vector<const Component*> psf_candidates(const Scene& scene,
                                             const std::vector<Component>& components) {
  std::vector<const Component*> bright;
  for (const Component& c : components)
    if (has_extent_of_star(scene, c)) bright.push_back(&c);
  std::sort(bright.begin(), bright.end(), is_brighter);
  while (bright.size() > enough_bright && bright.back()->peak_snr < bright_peak_snr)
    bright.pop_back();
  // First the brightest of each zone, then the second of each.
  std::array<int, zones_across * zones_down> in_zone{};
  std::vector<std::pair<int, const Component*>> ranked;
  for (const Component* c : bright) {
    const int zone_x = c->peak_x * zones_across / scene.counts.columns;
    const int zone_y = c->peak_y * zones_down / scene.counts.rows;
    ranked.emplace_back(in_zone[std::size_t(zone_y * zones_across + zone_x)]++, c);
  }
  std::ranges::stable_sort(ranked, {}, [](const auto& star) { return star.first; });
  std::vector<const Component*> out;
  for (const auto& [rank, c] : ranked) out.push_back(c);
  return out;
}

ComponentMap::ComponentMap(const std::vector<Component>& components, int columns, int rows)
    : columns_((columns + cell_px - 1) / cell_px),
      rows_((rows + cell_px - 1) / cell_px),
      cells_(std::size_t(columns_) * std::size_t(rows_)) {
  for (const Component& c : components)
    for (int j = c.min_y / cell_px; j <= c.max_y / cell_px; ++j)
      for (int i = c.min_x / cell_px; i <= c.max_x / cell_px; ++i)
        cells_[std::size_t(j * columns_ + i)].push_back(&c);
}

ComponentMap::Box ComponentMap::box_around(const Trail& trail, double reach_px) {
  const double x = trail.length_px / 2 * std::abs(std::cos(trail.angle_rad)) + reach_px;
  const double y = trail.length_px / 2 * std::abs(std::sin(trail.angle_rad)) + reach_px;
  return {int(std::floor(trail.x_px - x)), int(std::floor(trail.y_px - y)),
          int(std::ceil(trail.x_px + x)), int(std::ceil(trail.y_px + y))};
}

template <class Visit>
void ComponentMap::for_others(const Box& box, const Component& own, const Visit& visit) const {
  const int i0 = std::max(0, box.x0 / cell_px), i1 = std::min(columns_ - 1, box.x1 / cell_px);
  const int j0 = std::max(0, box.y0 / cell_px), j1 = std::min(rows_ - 1, box.y1 / cell_px);
  for (int j = j0; j <= j1; ++j)
    for (int i = i0; i <= i1; ++i)
      for (const Component* c : cells_[std::size_t(j * columns_ + i)])
        if (c != &own && c->max_x >= box.x0 && c->min_x <= box.x1 && c->max_y >= box.y0 &&
            c->min_y <= box.y1)
          visit(*c);
}

bool ComponentMap::is_alone(const Trail& trail, double reach_px, const Component& own) const {
  bool alone = true;
  for_others(box_around(trail, reach_px), own, [&](const Component&) { alone = false; });
  return alone;
}

std::vector<FitPixel> ComponentMap::pixels_around(const Scene& scene, const Trail& trail,
                                                  double reach_px, const Component& own,
                                                  int every) const {
  Box box = box_around(trail, reach_px);
  box = {std::max(box.x0, 0), std::max(box.y0, 0), std::min(box.x1, scene.counts.columns - 1),
         std::min(box.y1, scene.counts.rows - 1)};
  const int width = box.x1 - box.x0 + 1, height = box.y1 - box.y0 + 1;
  if (width <= 0 || height <= 0) return {};
  std::vector<bool> others(std::size_t(width) * std::size_t(height));
  for_others(box, own, [&](const Component& c) {
    for (const Run& run : c.runs)
      for (int y = std::max(run.y - 2, box.y0); y <= std::min(run.y + 2, box.y1); ++y)
        for (int x = std::max(run.first_x - 2, box.x0); x <= std::min(run.last_x + 2, box.x1); ++x)
          others[std::size_t(y - box.y0) * std::size_t(width) + std::size_t(x - box.x0)] = true;
  });
  std::vector<FitPixel> out;
  const Around around(trail, reach_px);
  for (int y = box.y0; y <= box.y1; y += every)
    for (int x = box.x0; x <= box.x1; x += every)
      if (around.has(x, y) && scene.is_usable(x, y) &&
          !others[std::size_t(y - box.y0) * std::size_t(width) + std::size_t(x - box.x0)])
        out.push_back(scene.pixel(x, y));
  return out;
}

}  // namespace dmise
