#include "core/calibration/deblend.h"

#include <algorithm>

namespace dmise {
namespace {

constexpr std::size_t least_pixels = 3;
constexpr int most_levels = 60;

struct BlendPixel {
  int x, y;
  double value;
};
using BlendPixels = std::vector<BlendPixel>;

/// The 8-connected parts of pixels sorted by (y, x).
std::vector<BlendPixels> parts_of(const BlendPixels& pixels) {
  std::vector<BlendPixels> parts;
  std::vector<char> seen(pixels.size(), 0);
  std::vector<std::size_t> open;
  const auto find = [&](int x, int y) {
    const auto at = std::lower_bound(pixels.begin(), pixels.end(), std::pair(y, x),
                                     [](const BlendPixel& p, const std::pair<int, int>& yx) {
                                       return std::pair(p.y, p.x) < yx;
                                     });
    return at != pixels.end() && at->x == x && at->y == y ? at - pixels.begin() : -1;
  };
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    if (seen[i]) continue;
    parts.emplace_back();
    open = {i};
    seen[i] = 1;
    while (!open.empty()) {
      const BlendPixel p = pixels[open.back()];
      open.pop_back();
      parts.back().push_back(p);
      for (int dy = -1; dy <= 1; ++dy)
        for (int dx = -1; dx <= 1; ++dx)
          if (const auto k = find(p.x + dx, p.y + dy); k >= 0 && !seen[std::size_t(k)]) {
            seen[std::size_t(k)] = 1;
            open.push_back(std::size_t(k));
          }
    }
  }
  for (BlendPixels& part : parts)
    std::sort(part.begin(), part.end(), [](const BlendPixel& a, const BlendPixel& b) {
      return std::pair(a.y, a.x) < std::pair(b.y, b.x);
    });
  return parts;
}

Component component_of(const BlendPixels& pixels, float peak_snr) {
  Component c{.min_x = pixels[0].x, .max_x = pixels[0].x, .min_y = pixels[0].y,
              .max_y = pixels.back().y, .pixels = int(pixels.size()), .peak_snr = peak_snr};
  double highest = -1.0;
  for (const BlendPixel& p : pixels) {
    c.min_x = std::min(c.min_x, p.x);
    c.max_x = std::max(c.max_x, p.x);
    if (!c.runs.empty() && c.runs.back().y == p.y && c.runs.back().last_x == p.x - 1)
      c.runs.back().last_x = p.x;
    else
      c.runs.push_back({p.y, p.x, p.x});
    if (p.value <= highest) continue;
    highest = p.value;
    c.peak_x = p.x;
    c.peak_y = p.y;
  }
  return c;
}

/// Appends the parts of pixels that rise apart; false if there are fewer than two.
bool split(const BlendPixels& pixels, double factor, float peak_snr, std::vector<Component>& out) {
  double threshold = pixels[0].value;
  for (const BlendPixel& p : pixels) threshold = std::min(threshold, p.value);
  BlendPixels above = pixels;
  for (int level = 0; level < most_levels; ++level) {
    threshold *= factor;
    std::erase_if(above, [&](const BlendPixel& p) { return p.value <= threshold; });
    if (above.size() < least_pixels) return false;
    auto parts = parts_of(above);
    std::erase_if(parts, [](const BlendPixels& p) { return p.size() < least_pixels; });
    if (parts.size() < 2) continue;
    for (const BlendPixels& part : parts)
      if (!split(part, factor, peak_snr, out)) out.push_back(component_of(part, peak_snr));
    return true;
  }
  return false;
}

}  // namespace

std::vector<Component> deblend(const Component& component, double factor,
                               const std::function<double(int, int)>& value) {
  BlendPixels pixels;
  for (const Run& run : component.runs)
    for (int x = run.first_x; x <= run.last_x; ++x)
      if (const double v = value(x, run.y); v > 0) pixels.push_back({x, run.y, v});
  std::vector<Component> out;
  if (pixels.size() < 2 * least_pixels || !split(pixels, factor, component.peak_snr, out))
    return {component};
  return out;
}

}  // namespace dmise
