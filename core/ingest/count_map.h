#pragma once
#include <span>
#include <vector>

#include "core/base/image.h"
#include "core/products/pixel_mask.h"

namespace dmise {

/// How values of any range are mapped to 16 bits: count = (value - zero) / step, rounded, and
/// clipped to 0..65535.
struct CountMap {
  double zero = 0.0, step = 1.0;

  double count(double value) const { return (value - zero) / step; }
  bool is_identity() const { return zero == 0.0 && step == 1.0; }
};

/// Noise of a pixel: the scatter of differences of pixels four columns apart, so that light of
/// neighbours and slopes count little. `values`: rows x columns, NaN where there is none; 0 if no
/// two pixels can be compared.
double pixel_noise(std::span<const double> values, int columns);

/// The step that nearly all of some whole numbers in 0..65535 share, as where counts of 12 bits
/// were padded to 16, and the least number on it; a step of 1 if they share none. A few values may
/// be off it, as where a camera clips at 65535 or has mended pixels.
CountMap common_step(std::span<const double> values);

/// The map of an image. Whole numbers in 0..65535 keep the step that they share: a noise of less
/// than a step is then not lost. Others get at most a sixteenth of the pixels' noise, or 1 for
/// whole numbers; where the range is then too wide its bright end is clipped.
CountMap choose_count_map(std::span<const double> values, int columns);

/// The greatest value, if so many pixels share it that they must be clipped; else 0 pixels.
struct Ceiling {
  double value = 0.0;
  std::size_t pixels = 0;
};
Ceiling find_ceiling(std::span<const double> values);

/// Counts of an image. Pixels without a value get the sky's level and noise around them, so that
/// nothing is found there, and are marked in `unusable`, which stays empty if there are none.
CountImage to_counts(std::span<const double> values, int columns, const CountMap& map,
                     PixelMask& unusable);

}  // namespace dmise
