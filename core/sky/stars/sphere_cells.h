#pragma once
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/frames/vec.h"

namespace dmise {

// The sphere is cut into bands of declination, and these into cells of about equal area. Cells are
// numbered by band, then by right ascension.

/// Number of each band's first cell, and of all cells: bands + 1.
std::vector<std::uint32_t> first_cells(int bands);

/// The cell of a place.
std::uint32_t cell_at(std::span<const std::uint32_t> first_cell, double ra_rad, double dec_rad);

/// A run of consecutive cells: first and last.
using CellRun = std::pair<std::uint32_t, std::uint32_t>;

/// All cells that have a place within `radius_rad` of `axis` (unit), in order, and a few that have
/// none.
std::vector<CellRun> cells_around(std::span<const std::uint32_t> first_cell, const Vec<Gcrs>& axis,
                                  double radius_rad);

/// The cells of one division.
class SphereCells {
 public:
  explicit SphereCells(int bands);

  struct Cell {
    std::uint32_t number = 0;
    double ra_rad = 0.0, width_rad = 0.0;     // its first right ascension, and its width
    double low_sine = -1.0, high_sine = 1.0;  // ends of its declinations
    Vec<Gcrs> middle;                         // unit
    double area_sr() const { return width_rad * (high_sine - low_sine); }
  };

  std::uint32_t count() const { return first_cell_.back(); }
  Cell cell(std::uint32_t number) const;
  std::uint32_t at(const Vec<Gcrs>& direction) const;
  /// Half of the largest extent of a cell [rad].
  double half_rad() const;
  std::vector<CellRun> around(const Vec<Gcrs>& axis, double radius_rad) const {
    return cells_around(first_cell_, axis, radius_rad);
  }

 private:
  double band_rad_;
  std::vector<std::uint32_t> first_cell_;
};

}  // namespace dmise
