#include "core/astrometry/deblend.h"

#include <algorithm>
#include <deque>
#include <functional>
#include <utility>

namespace dmise {
namespace {

constexpr std::size_t min_pixels = 3;
constexpr double min_factor = 1.5;  // a peak's value over a saddle's

struct BlendPixel {
  int x, y;
  double value;
};

Component component_of(std::vector<BlendPixel> pixels, float peak_snr) {
  Component c{.min_x = pixels[0].x,
              .max_x = pixels[0].x,
              .pixels = int(pixels.size()),
              .peak_snr = peak_snr,
              .peak_x = pixels[0].x,  // the highest comes first
              .peak_y = pixels[0].y};
  std::ranges::sort(pixels, {}, [](const BlendPixel& p) { return std::pair(p.y, p.x); });
  c.min_y = pixels.front().y;
  c.max_y = pixels.back().y;
  for (const BlendPixel& p : pixels) {
    c.min_x = std::min(c.min_x, p.x);
    c.max_x = std::max(c.max_x, p.x);
    if (!c.runs.empty() && c.runs.back().y == p.y && c.runs.back().last_x == p.x - 1)
      c.runs.back().last_x = p.x;
    else
      c.runs.push_back({p.y, p.x, p.x});
  }
  return c;
}

/// Pixels joined from the highest down.
struct Peak {
  std::vector<BlendPixel> pixels;
  Peak* joined_to = nullptr;
  bool split = false;  // holds parts that are listed

  double height() const { return pixels[0].value; }
  bool stands_over(double saddle, double min_rise) const {
    return pixels.size() >= min_pixels && height() >= min_factor * saddle &&
           height() >= saddle + min_rise;
  }
  Peak* root() {
    Peak* at = this;
    while (at->joined_to) at = at->joined_to;
    return at;
  }
};

}  // namespace

std::vector<Component> deblend(const Component& component, double min_rise,
                               const std::function<double(int, int)>& value) {
  std::vector<BlendPixel> pixels;
  for (const Run& run : component.runs)
    for (int x = run.first_x; x <= run.last_x; ++x)
      if (const double v = value(x, run.y); v > 0) pixels.push_back({x, run.y, v});
  if (pixels.size() < 2 * min_pixels) return {component};
  std::ranges::stable_sort(pixels, std::greater(), &BlendPixel::value);
  const int wide = component.max_x - component.min_x + 3;
  const int high = component.max_y - component.min_y + 3;
  std::vector<Peak*> peak_at(std::size_t(wide) * std::size_t(high));
  std::deque<Peak> peaks;
  std::vector<Component> parts;
  for (const BlendPixel& p : pixels) {
    const int at = (p.y - component.min_y + 1) * wide + p.x - component.min_x + 1;
    Peak* here = nullptr;
    for (const int step : {-wide - 1, -wide, -wide + 1, -1, 1, wide - 1, wide, wide + 1}) {
      Peak* const beside = peak_at[std::size_t(at + step)];
      if (!beside) continue;
      Peak* other = beside->root();
      if (!here) here = other;
      if (other == here) continue;
      if (other->height() > here->height()) std::swap(here, other);
      if (other->split || (other->stands_over(p.value, min_rise) &&
                           (here->split || here->stands_over(p.value, min_rise)))) {
        for (Peak* peak : {here, other}) {
          if (!peak->split && peak->stands_over(p.value, min_rise))
            parts.push_back(component_of(peak->pixels, component.peak_snr));
          peak->split = true;
        }
      } else if (!here->split) {
        here->pixels.insert(here->pixels.end(), other->pixels.begin(), other->pixels.end());
      }
      other->joined_to = here;
    }
    if (!here) here = &peaks.emplace_back();
    if (!here->split) here->pixels.push_back(p);
    peak_at[std::size_t(at)] = here;
  }
  if (parts.empty()) return {component};
  return parts;
}

}  // namespace dmise
