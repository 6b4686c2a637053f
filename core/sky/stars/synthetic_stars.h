#pragma once
#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <mutex>
#include <vector>

#include "core/sky/stars/star_map.h"

namespace dmise {

/// Stars fainter than those of a catalogue, drawn from `StarCounts`. The sky is cut into cells, and
/// a cell's stars are a function of the cell alone: every sensor, frame and run has the same,
/// whatever its seed. They have no parallax and do not move.
class SyntheticStars {
 public:
  /// `catalogue`: whose stars to `catalogue_to_v_mag` are drawn already; null for none. From where
  /// it is complete to there, a cell gets what its stars lack of the counts, by half magnitudes.
  SyntheticStars(std::shared_ptr<const StarMap> catalogue, double catalogue_to_v_mag,
                 double to_v_mag);

  /// Range of V of synthetic stars; empty unless the first is brighter.
  double from_v_mag() const { return from_v_mag_; }
  double to_v_mag() const { return to_v_mag_; }

  /// Stars of a part of the sky, cell by cell, in each the brightest first.
  struct Stars {
    std::vector<Vec<Gcrs>> direction;  // unit
    std::vector<std::uint64_t> id;     // its cell and its place there; of no other star
    std::vector<float> v_mag, bv;
  };
  /// Calls `use` for those brighter than `faintest_v_mag` of all cells that come within
  /// `radius_rad` of `axis` (unit), some of which are farther from it, `stars_at_a_time` or a few
  /// more at a time.
  void visit(const Vec<Gcrs>& axis, double radius_rad, double faintest_v_mag,
             const std::function<void(const Stars&)>& use) const;
  static constexpr std::size_t stars_at_a_time = 512;
  /// Stars of the cone in one piece.
  Stars around(const Vec<Gcrs>& axis, double radius_rad, double faintest_v_mag) const;

  /// Expected number of stars of `around`, without subtracting a catalogue's.
  double expected_around(const Vec<Gcrs>& axis, double radius_rad, double faintest_v_mag) const;
  /// Expected stars of a square degree in a direction (unit), likewise.
  double per_square_degree(const Vec<Gcrs>& direction, double faintest_v_mag) const;

 private:
  static constexpr double bin_mag = 0.5;
  static constexpr std::size_t max_bins = 48;
  using Missing = std::array<float, max_bins>;  // share of the counts, by half magnitude

  const Missing& missing_at(const Vec<Gcrs>& direction) const;
  Missing count_missing(std::uint32_t cell) const;

  std::shared_ptr<const StarMap> catalogue_;
  double catalogue_to_v_mag_, from_v_mag_, to_v_mag_;
  mutable std::mutex mutex_;
  mutable std::map<std::uint32_t, Missing> missing_;  // by coarse cell
};

/// Stars are marked as synthetic by this bit of their number.
inline constexpr std::uint64_t synthetic_star_bit = std::uint64_t(1) << 63;

}  // namespace dmise
