#include "core/fusion/sky_cells.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace dmise {

SkyCells::SkyCells(const Vec<Gcrs>& axis, double half_angle_rad)
    : z_(axis), reach_(half_angle_rad < pi / 2 ? std::sin(half_angle_rad) : 1.0) {
  const Vec<Gcrs> other = std::fabs(axis.z) < 0.9 ? Vec<Gcrs>{0, 0, 1} : Vec<Gcrs>{1, 0, 0};
  x_ = unit(cross(other, axis));
  y_ = cross(axis, x_);
}

int SkyCells::along(double coordinate) const {
  return std::clamp(int(std::floor((coordinate / reach_ + 1) / 2 * side)), 0, side - 1);
}

std::uint32_t SkyCells::cell_of(double x, double y, bool behind) const {
  return std::uint32_t((int(behind) * side + along(y)) * side + along(x));
}

void SkyCells::add(std::uint32_t id, const Vec<Gcrs>& direction, double radius_rad) {
  const double x = dot(direction, x_), y = dot(direction, y_), z = dot(direction, z_);
  // Orthographic coordinates change by at most the angle.
  const int left = along(x - radius_rad), right = along(x + radius_rad);
  const int bottom = along(y - radius_rad), top = along(y + radius_rad);
  for (const bool behind : {false, true}) {
    if (behind ? z > radius_rad : z < -radius_rad) continue;
    for (int row = bottom; row <= top; ++row)
      for (int column = left; column <= right; ++column)
        entries_.push_back({std::uint32_t((int(behind) * side + row) * side + column), id});
  }
}

void SkyCells::close() {
  begin_.assign(2 * side * side + 1, 0);
  for (const Entry& e : entries_) ++begin_[e.cell + 1];
  for (std::size_t i = 1; i < begin_.size(); ++i) begin_[i] += begin_[i - 1];
  ids_.resize(entries_.size());
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (const Entry& e : entries_) ids_[next[e.cell]++] = e.id;
  for (std::size_t i = 0; i + 1 < begin_.size(); ++i)
    if (begin_[i + 1] > begin_[i] + 1)
      std::sort(ids_.begin() + begin_[i], ids_.begin() + begin_[i + 1]);
}

std::span<const std::uint32_t> SkyCells::near(const Vec<Gcrs>& direction) const {
  const std::uint32_t cell =
      cell_of(dot(direction, x_), dot(direction, y_), dot(direction, z_) < 0);
  return {ids_.data() + begin_[cell], begin_[cell + 1] - begin_[cell]};
}

}  // namespace dmise
