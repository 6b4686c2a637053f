#include "sensors/scene/occlusion_mask.h"

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

constexpr int max_arc_steps = 4096;  // along one arc

/// Part of a pixel's width that lies within `half` of `at`.
double overlap(int pixel, double at, double half) {
  return std::max(0.0, std::min(pixel + 0.5, at + half) - std::max(pixel - 0.5, at - half));
}

}  // namespace

double OcclusionMask::free_at(PixelPosition at) const {
  if (empty()) return 1.0;
  const double x = std::round(at.x_px) + margin_px, y = std::round(at.y_px) + margin_px;
  if (!(x >= covered_.left && x < covered_.right && y >= covered_.top && y < covered_.bottom))
    return 1.0;
  return free_[index(int(x), int(y))];
}

std::vector<Arc> OcclusionMask::past(std::span<const Arc> path) const {
  if (empty()) return {path.begin(), path.end()};
  std::vector<Arc> free;
  for (const Arc& arc : path) {
    const ArcExtent e = extent(arc);
    if (e.right < covered_.left - margin_px - 1 || e.left > covered_.right - margin_px ||
        e.bottom < covered_.top - margin_px - 1 || e.top > covered_.bottom - margin_px) {
      free.push_back(arc);
      continue;
    }
    const int steps = int(std::clamp(std::ceil(2.0 * length_px(arc)), 1.0, double(max_arc_steps)));
    const auto share_of = [&](int i) { return free_at(place(arc, (i + 0.5) / steps)); };
    for (int first = 0, next; first < steps; first = next) {
      const double share = share_of(first);
      for (next = first + 1; next < steps && share_of(next) == share; ++next) {
      }
      if (!(share > 0.0)) continue;
      Arc part =
          steps == next - first ? arc : part_of(arc, double(first) / steps, double(next) / steps);
      part.signal_e *= share;
      free.push_back(part);
    }
  }
  return free;
}

void OcclusionMask::cover(PixelPosition at, double side_px, double hidden_px) {
  const double x = at.x_px + margin_px, y = at.y_px + margin_px, half = side_px / 2;
  if (!(x + half > -0.5 && y + half > -0.5 && x - half < columns_ && y - half < rows_)) return;
  const int left = std::max(0, int(std::floor(x - half + 0.5)));
  const int top = std::max(0, int(std::floor(y - half + 0.5)));
  const int right = std::min(columns_, int(std::floor(x + half + 0.5)) + 1);
  const int bottom = std::min(rows_, int(std::floor(y + half + 0.5)) + 1);
  if (right <= left || bottom <= top) return;
  if (hidden_.empty()) hidden_.assign(std::size_t(columns_) * std::size_t(rows_), 0.0f);
  const double per_px = hidden_px / (side_px * side_px);
  for (int j = top; j < bottom; ++j)
    for (int i = left; i < right; ++i)
      hidden_[index(i, j)] += float(per_px * overlap(i, x, half) * overlap(j, y, half));
  if (next_.right == 0) next_ = {left, top, right, bottom};
  next_ = {std::min(next_.left, left), std::min(next_.top, top), std::max(next_.right, right),
           std::max(next_.bottom, bottom)};
}

void OcclusionMask::close() {
  if (next_.right == 0) return;
  if (free_.empty()) {
    free_.assign(hidden_.size(), 1.0f);
    covered_ = next_;
  }
  // Sums of parts come to 1 but for rounding.
  constexpr float nearly_all = 1e-4f;
  for (int y = next_.top; y < next_.bottom; ++y)
    for (int x = next_.left; x < next_.right; ++x) {
      float& hidden = hidden_[index(x, y)];
      free_[index(x, y)] *= hidden > 1.0f - nearly_all ? 0.0f : 1.0f - hidden;
      hidden = 0.0f;
    }
  covered_ = {std::min(covered_.left, next_.left), std::min(covered_.top, next_.top),
              std::max(covered_.right, next_.right), std::max(covered_.bottom, next_.bottom)};
  next_ = {};
}

void OcclusionMask::take_hidden(const ExpectedElectronImage& behind,
                                ExpectedElectronImage& image) const {
  if (empty()) return;
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.columns; ++x) {
      const float free = free_[index(x + margin_px, y + margin_px)];
      if (free < 1.0f)
        image.at(x, y) = std::max(0.0f, image.at(x, y) - behind.at(x, y) * (1.0f - free));
    }
}

}  // namespace dmise
