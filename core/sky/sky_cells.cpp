#include "core/sky/sky_cells.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace dmise {

SkyCells::SkyCells(int bands) : bands_(bands), band_rad_(pi / bands), first_cell_{0} {
  for (int b = 0; b < bands; ++b) {
    const double middle = (b + 0.5) * band_rad_ - pi / 2;
    const double cells = std::max(3.0, std::round(2 * pi * std::cos(middle) / band_rad_));
    first_cell_.push_back(first_cell_.back() + std::uint32_t(cells));
  }
}

int SkyCells::band_of(double declination_rad) const {
  return std::clamp(int((declination_rad + pi / 2) / band_rad_), 0, bands_ - 1);
}

SkyCells::Cell SkyCells::cell(std::uint32_t number) const {
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

std::uint32_t SkyCells::at(const Vec<Gcrs>& direction) const {
  const auto [ra, dec] = to_spherical(direction);
  const int band = band_of(dec);
  const std::uint32_t cells = first_cell_[band + 1] - first_cell_[band];
  return first_cell_[band] + std::min(std::uint32_t(ra / (2 * pi) * cells), cells - 1);
}

double SkyCells::half_rad() const { return 1.5 * band_rad_; }

void SkyCells::around(const Vec<Gcrs>& axis, double radius_rad,
                      std::vector<std::uint32_t>& found) const {
  const auto [ra, dec] = to_spherical(axis);
  const double margin = 1e-9;
  const double low = dec - radius_rad - margin, high = dec + radius_rad + margin;
  const bool holds_pole = low <= -pi / 2 || high >= pi / 2;
  // A cone without a pole spans asin(sin r / cos dec) of right ascension to either side.
  const double ratio = std::sin(std::min(radius_rad + margin, pi / 2)) / std::cos(dec);
  const double half_ra = holds_pole || ratio >= 1 ? pi : std::asin(ratio) + margin;
  for (int b = band_of(low); b <= band_of(high); ++b) {
    const std::uint32_t first = first_cell_[b];
    const auto cells = std::int64_t(first_cell_[b + 1] - first);
    const auto place = [&](double at) {
      return std::int64_t(std::floor(at / (2 * pi) * double(cells)));
    };
    const std::int64_t from = place(ra - half_ra), to = place(ra + half_ra);
    if (to - from + 1 >= cells) {
      for (std::int64_t k = 0; k < cells; ++k) found.push_back(first + std::uint32_t(k));
      continue;
    }
    std::vector<std::uint32_t> of_band;
    for (std::int64_t k = from; k <= to; ++k)
      of_band.push_back(first + std::uint32_t((k % cells + cells) % cells));
    std::sort(of_band.begin(), of_band.end());
    found.insert(found.end(), of_band.begin(), of_band.end());
  }
}

}  // namespace dmise
