#pragma once
#include <span>
#include <vector>

#include "core/base/image.h"
#include "core/optics/blur/deposit.h"

namespace dmise {

/// The share of the exposure in which no object with a shape hides what is behind it, for every
/// pixel of the frame and of a margin about it. Objects are added nearest first.
class OcclusionMask {
 public:
  static constexpr int margin_px = 32;

  OcclusionMask(int columns, int rows)
      : columns_(columns + 2 * margin_px), rows_(rows + 2 * margin_px) {}

  /// Whether nothing is hidden anywhere.
  bool empty() const { return free_.empty(); }
  /// Share of the light that gets past at the pixel that holds a place, [0, 1].
  double free_at(PixelPosition at) const;
  /// Returns the parts of a path that are not hidden, cut in steps of half a pixel.
  std::vector<Arc> past(std::span<const Arc> path) const;

  /// A part of the next object: an even square of `side_px` about a place, `hidden_px` pixels times
  /// shares of the exposure in all.
  void cover(PixelPosition at, double side_px, double hidden_px);
  /// Ends that object: from now on it hides what is asked for or added.
  void close();

  /// Takes what is hidden of `behind` from `image`, both of the frame.
  void take_hidden(const ExpectedElectronImage& behind, ExpectedElectronImage& image) const;

 private:
  /// Pixels from the first to before the last, of the mask.
  struct Box {
    int left = 0, top = 0, right = 0, bottom = 0;
  };
  std::size_t index(int x, int y) const {
    return std::size_t(y) * std::size_t(columns_) + std::size_t(x);
  }

  int columns_, rows_;  // with the margin
  std::vector<float> free_, hidden_;
  Box covered_, next_;
};

}  // namespace dmise
