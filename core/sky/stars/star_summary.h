#pragma once
#include <array>
#include <cstddef>
#include <cstdint>

#include "core/sky/stars/star_catalogue.h"

namespace dmise {

/// Summary of all stars of a catalogue, for use without iterating over them.
struct StarSummary {
  static constexpr double first_v_mag = -2.0, step_mag = 0.1;
  static constexpr std::size_t bins = 320;

  /// Stars by tenths of a magnitude from `first_v_mag`; what lies beyond is in the bins at the
  /// ends.
  std::array<std::uint64_t, bins> count{};
  double faintest_filled_v_mag = 0.0;  // as the function of that name says
  double largest_parallax_rad = 0.0;

  /// Brightest V of a bin.
  static double bright_edge(std::size_t bin) { return first_v_mag + step_mag * double(bin); }
  /// Number of stars not fainter than a magnitude, to a bin.
  std::uint64_t brighter_than(double v_mag) const;
  /// Magnitude, to a bin, that at least so many stars reach; that of the faintest if there are
  /// fewer.
  double magnitude_of_rank(double rank) const;

  bool operator==(const StarSummary&) const = default;
};

StarSummary summary_of(const StarTable& stars);

}  // namespace dmise
