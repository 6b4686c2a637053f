#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/frames/vec.h"

namespace dmise {

/// Directions in cells of a sensor's sky, to find those near another. A direction is entered in
/// all cells that its radius touches, so that a search looks at one.
class SkyCells {
 public:
  /// Covers the cone about `axis` (unit) with `half_angle_rad`, (0, pi].
  SkyCells(const Vec<Gcrs>& axis, double half_angle_rad);

  /// `id` may be of a source within `radius_rad` of `direction` (unit).
  void add(std::uint32_t id, const Vec<Gcrs>& direction, double radius_rad);
  /// Call once, after the last `add`.
  void close();
  /// Ids that may be of a source in this direction, ascending. All that are, and some others.
  std::span<const std::uint32_t> near(const Vec<Gcrs>& direction) const;

 private:
  static constexpr int side = 96;
  struct Entry {
    std::uint32_t cell, id;
  };
  int along(double coordinate) const;
  std::uint32_t cell_of(double x, double y, bool behind) const;

  Vec<Gcrs> x_, y_, z_;
  double reach_;  // largest coordinate x or y, which are orthographic
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> begin_, ids_;
};

}  // namespace dmise
