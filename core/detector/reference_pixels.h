#pragma once
#include <algorithm>

#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// A border of pixels that are read but collect nothing.
struct ReferencePixels {
  static constexpr EffectFacts facts{"reference_pixels",
                                     "border pixels without light and dark current",
                                     "the border collects light as the rest does", "geometry"};
  int reference_px = 0;  // width of the border
  bool operator==(const ReferencePixels&) const = default;

  static std::span<const ParameterOf<ReferencePixels>> parameters();
  void switch_off() { reference_px = 0; }
  bool applies(const Detector&) const { return reference_px > 0; }
  void apply(const ExposureFacts& exposed, Piece& piece) const;
  static ErrorBound error(int, const PlanFacts&) { return not_bounded; }
  static double cost_s(int level, const PlanFacts& f);
};

/// Calls visit(begin, end) for the ranges of `count` pixels from `first` on, relative to `first`,
/// that are in a border `border_px` wide.
template <class Visit>
void visit_border(int border_px, int columns, int rows, std::size_t first, std::size_t count,
                  const Visit& visit) {
  const auto width = std::size_t(columns), border = std::size_t(border_px);
  // Row by row: whole rows at the top and bottom, both ends of the others.
  for (std::size_t i = 0; i < count;) {
    const std::size_t x = (first + i) % width, y = (first + i) / width;
    const std::size_t end = std::min(count, i + width - x);
    if (y < border || y + border >= std::size_t(rows) || 2 * border >= width) {
      visit(i, end);
    } else {
      const auto at = [&](std::size_t column) {  // index of a place in this row
        return std::min(end, column > x ? i + (column - x) : i);
      };
      visit(i, at(border));
      visit(at(width - border), end);
    }
    i = end;
  }
}

}  // namespace dmise
