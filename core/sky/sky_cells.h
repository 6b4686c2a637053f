#pragma once
#include <cstdint>
#include <vector>

#include "core/frames/vec.h"

namespace dmise {

/// The sphere in bands of declination, each in cells of about equal area.
class SkyCells {
 public:
  explicit SkyCells(int bands);

  struct Cell {
    std::uint32_t number = 0;
    double ra_rad = 0.0, width_rad = 0.0;     // its first right ascension, and its width
    double low_sine = -1.0, high_sine = 1.0;  // of its declinations
    Vec<Gcrs> middle;                         // unit
    double area_sr() const { return width_rad * (high_sine - low_sine); }
  };

  std::uint32_t count() const { return first_cell_.back(); }
  Cell cell(std::uint32_t number) const;
  std::uint32_t at(const Vec<Gcrs>& direction) const;
  /// Half of the largest extent of a cell [rad].
  double half_rad() const;
  /// Appends the numbers of all cells with a place within `radius_rad` of `axis` (unit), in order;
  /// some have none.
  void around(const Vec<Gcrs>& axis, double radius_rad, std::vector<std::uint32_t>& found) const;

 private:
  int band_of(double declination_rad) const;

  int bands_;
  double band_rad_;
  std::vector<std::uint32_t> first_cell_;  // bands + 1
};

}  // namespace dmise
