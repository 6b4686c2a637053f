#pragma once
#include <array>
#include <optional>
#include <span>
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/ingest/count_map.h"

namespace dmise {

/// The pixels of a colour camera, behind a mosaic of dyes that repeats every two columns and rows.
/// Which dye a pixel has does not matter: each of the four kinds has a sky of its own, and a
/// response of its own to the light of the frame's sources.
class ColourMosaic {
 public:
  /// `values`: rows x columns, NaN where there is none; two columns and rows at least.
  ColourMosaic(std::span<const double> values, int columns, Threads& threads);

  /// The share of the sources' light that each kind records, over the mean of all: row 0 before row
  /// 1, column 0 before 1. Measured with the brightest pixels; empty if there are too few.
  const std::optional<std::array<double, 4>>& responses() const { return responses_; }
  /// The values as they were if all kinds had the mean sky and the mean response.
  std::vector<double> evened() const;
  /// The evened value that a value has, at the median sky, in the kind where it is the least.
  double min_evened(double value) const;
  /// The pixels of each kind alone.
  const std::array<CountImage, 4>& kinds() const { return kinds_; }
  /// The map of their counts.
  const CountMap& map() const { return map_; }

 private:
  std::array<float, 4> levels_around(int column, int row) const;
  void measure_responses(const std::array<double, 4>& noise);

  std::span<const double> values_;
  int columns_, rows_;
  CountMap map_;
  std::array<CountImage, 4> kinds_;
  std::array<std::vector<float>, 4> sky_;  // level at each pixel of a kind, in values
  std::array<double, 4> median_{};
  std::optional<std::array<double, 4>> responses_;
};

}  // namespace dmise
