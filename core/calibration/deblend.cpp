#include "core/calibration/deblend.h"

#include <algorithm>
#include <functional>
#include <utility>

namespace dmise {
namespace {

constexpr std::size_t least_pixels = 3;

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
  int joined_to = -1;
  bool split = false;  // holds parts that are listed

  bool stands_over(double saddle, const DeblendSettings& s) const {
    return pixels.size() >= least_pixels && pixels[0].value >= s.factor * saddle &&
           pixels[0].value >= saddle + s.least_rise;
  }
};

}  // namespace

std::vector<Component> deblend(const Component& component, const DeblendSettings& settings,
                               const std::function<double(int, int)>& value) {
  std::vector<BlendPixel> pixels;
  for (const Run& run : component.runs)
    for (int x = run.first_x; x <= run.last_x; ++x)
      if (const double v = value(x, run.y); v > 0) pixels.push_back({x, run.y, v});
  if (pixels.size() < 2 * least_pixels) return {component};
  std::ranges::stable_sort(pixels, std::greater(), &BlendPixel::value);
  const int wide = component.max_x - component.min_x + 3;
  std::vector<int> peak_at(std::size_t(wide) * std::size_t(component.max_y - component.min_y + 3),
                           -1);
  std::vector<Peak> peaks;
  const auto root = [&](int i) {
    while (peaks[std::size_t(i)].joined_to >= 0) i = peaks[std::size_t(i)].joined_to;
    return i;
  };
  std::vector<Component> parts;
  for (const BlendPixel& p : pixels) {
    const int at = (p.y - component.min_y + 1) * wide + p.x - component.min_x + 1;
    int here = -1;
    for (const int step : {-wide - 1, -wide, -wide + 1, -1, 1, wide - 1, wide, wide + 1}) {
      const int beside = peak_at[std::size_t(at + step)];
      if (beside < 0) continue;
      int other = root(beside);
      if (here < 0) here = other;
      if (other == here) continue;
      if (peaks[std::size_t(other)].pixels[0].value > peaks[std::size_t(here)].pixels[0].value)
        std::swap(here, other);
      Peak &high = peaks[std::size_t(here)], &low = peaks[std::size_t(other)];
      if (low.split || (low.stands_over(p.value, settings) &&
                        (high.split || high.stands_over(p.value, settings)))) {
        for (Peak* peak : {&high, &low}) {
          if (!peak->split && peak->stands_over(p.value, settings))
            parts.push_back(component_of(peak->pixels, component.peak_snr));
          peak->split = true;
        }
      } else if (!high.split) {
        high.pixels.insert(high.pixels.end(), low.pixels.begin(), low.pixels.end());
      }
      low.joined_to = here;
    }
    if (here < 0) {
      here = int(peaks.size());
      peaks.emplace_back();
    }
    if (!peaks[std::size_t(here)].split) peaks[std::size_t(here)].pixels.push_back(p);
    peak_at[std::size_t(at)] = here;
  }
  if (parts.empty()) return {component};
  return parts;
}

}  // namespace dmise
