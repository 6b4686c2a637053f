#include "core/sky/stars/sphere_cells.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

int band_of(double dec_rad, int bands) {
  return std::clamp(int((dec_rad + pi / 2) / (pi / bands)), 0, bands - 1);
}

}  // namespace

std::vector<std::uint32_t> first_cells(int bands) {
  const double band_rad = pi / bands;
  std::vector<std::uint32_t> first(std::size_t(bands) + 1, 0);
  for (int b = 0; b < bands; ++b) {
    const double middle = (b + 0.5) * band_rad - pi / 2;
    const double cells = std::max(3.0, std::round(2 * pi * std::cos(middle) / band_rad));
    first[b + 1] = first[b] + std::uint32_t(cells);
  }
  return first;
}

std::uint32_t cell_at(std::span<const std::uint32_t> first_cell, double ra_rad, double dec_rad) {
  const auto b = std::size_t(band_of(dec_rad, int(first_cell.size()) - 1));
  const std::uint32_t cells = first_cell[b + 1] - first_cell[b];
  return first_cell[b] + std::min(std::uint32_t(ra_rad / (2 * pi) * cells), cells - 1);
}

std::vector<CellRun> cells_around(std::span<const std::uint32_t> first_cell, const Vec<Gcrs>& axis,
                                  double radius_rad) {
  const int bands = int(first_cell.size()) - 1;
  const auto [ra, dec] = to_spherical(axis);
  const double margin = 1e-9;  // cells are chosen a little wider than the cone
  const double low = dec - radius_rad - margin, high = dec + radius_rad + margin;
  const bool holds_pole = low <= -pi / 2 || high >= pi / 2;
  // A cone without a pole spans asin(sin r / cos dec) of right ascension to either side.
  const double ratio = std::sin(std::min(radius_rad + margin, pi / 2)) / std::cos(dec);
  const double half_ra = holds_pole || ratio >= 1 ? pi : std::asin(ratio) + margin;
  std::vector<CellRun> runs;
  for (int b = band_of(low, bands); b <= band_of(high, bands); ++b) {
    const std::uint32_t first = first_cell[std::size_t(b)];
    const auto cells = std::int64_t(first_cell[std::size_t(b) + 1] - first);
    const auto add = [&](std::int64_t from, std::int64_t to) {
      if (from <= to) runs.emplace_back(first + std::uint32_t(from), first + std::uint32_t(to));
    };
    const double per_rad = double(cells) / (2 * pi);
    const auto from = std::int64_t(std::floor((ra - half_ra) * per_rad));
    const auto to = std::int64_t(std::floor((ra + half_ra) * per_rad));
    if (to - from + 1 >= cells) {
      add(0, cells - 1);
    } else if (from < 0) {  // through 0 h
      add(0, to);
      add(from + cells, cells - 1);
    } else if (to >= cells) {
      add(0, to - cells);
      add(from, cells - 1);
    } else {
      add(from, to);
    }
  }
  return runs;
}

SphereCells::SphereCells(int bands) : band_rad_(pi / bands), first_cell_(first_cells(bands)) {}

SphereCells::Cell SphereCells::cell(std::uint32_t number) const {
  const auto after = std::upper_bound(first_cell_.begin(), first_cell_.end(), number);
  const int band = int(after - first_cell_.begin()) - 1;
  const double width = 2 * pi / double(first_cell_[band + 1] - first_cell_[band]);
  const double low = band * band_rad_ - pi / 2;
  const double ra = (number - first_cell_[band]) * width;
  return {.number = number,
          .ra_rad = ra,
          .width_rad = width,
          .low_sine = std::sin(low),
          .high_sine = std::sin(low + band_rad_),
          .middle = from_spherical<Gcrs>(ra + 0.5 * width, low + 0.5 * band_rad_)};
}

std::uint32_t SphereCells::at(const Vec<Gcrs>& direction) const {
  const auto [ra, dec] = to_spherical(direction);
  return cell_at(first_cell_, ra, dec);
}

double SphereCells::half_rad() const { return 1.5 * band_rad_; }

}  // namespace dmise
