#include "core/sky/star_index.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <utility>

#include "core/base/units.h"

namespace dmise {
namespace {

constexpr int band_count = 90;  // of 2 degrees: some 12 stars a cell with 126,000 stars
constexpr double band_rad = pi / band_count;

int band_of(double dec_rad) {
  return std::clamp(int((dec_rad + pi / 2) / band_rad), 0, band_count - 1);
}

template <class T>
void reorder(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
  std::vector<T> sorted(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = values[order[i]];
  values = std::move(sorted);
}

std::vector<std::uint32_t> first_cells() {
  std::vector<std::uint32_t> first(band_count + 1, 0);
  for (int b = 0; b < band_count; ++b) {
    const double middle = (b + 0.5) * band_rad - pi / 2;
    const double cells = std::max(3.0, std::round(2 * pi * std::cos(middle) / band_rad));
    first[b + 1] = first[b] + std::uint32_t(cells);
  }
  return first;
}

}  // namespace

StarIndex build_star_index(StarCatalogue& c) {
  StarIndex index{.bands = band_count, .first_cell = first_cells()};
  const std::size_t n = c.size();
  std::vector<std::uint32_t> cell(n);
  for (std::size_t i = 0; i < n; ++i) {
    const int b = band_of(c.dec_rad[i]);
    const std::uint32_t cells = index.first_cell[b + 1] - index.first_cell[b];
    const auto within = std::uint32_t(c.ra_rad[i] / (2 * pi) * cells);
    cell[i] = index.first_cell[b] + std::min(within, cells - 1);
  }
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (cell[a] != cell[b]) return cell[a] < cell[b];
    if (c.v_mag[a] != c.v_mag[b]) return c.v_mag[a] < c.v_mag[b];
    return a < b;
  });
  reorder(c.id, order);
  reorder(c.ra_rad, order);
  reorder(c.dec_rad, order);
  reorder(c.pm_ra_cosdec_rad_per_yr, order);
  reorder(c.pm_dec_rad_per_yr, order);
  reorder(c.parallax_rad, order);
  reorder(c.v_mag, order);
  reorder(c.bv, order);
  reorder(c.flags, order);

  std::vector<std::uint32_t> first_star(index.first_cell[band_count] + 1, 0);
  for (const std::uint32_t one : cell) ++first_star[one + 1];
  std::partial_sum(first_star.begin(), first_star.end(), first_star.begin());
  std::vector<Vec<Gcrs>> direction(n);
  for (std::size_t i = 0; i < n; ++i) {
    direction[i] = from_spherical<Gcrs>(c.ra_rad[i], c.dec_rad[i]);
    index.fastest_motion_rad_per_yr =
        std::max(index.fastest_motion_rad_per_yr,
                 std::hypot(c.pm_ra_cosdec_rad_per_yr[i], c.pm_dec_rad_per_yr[i]));
  }
  index.first_star = std::move(first_star);
  index.direction = std::move(direction);
  return index;
}

bool is_sound(const StarIndex& index, std::size_t stars) {
  if (index.bands != band_count || !std::ranges::equal(index.first_cell, first_cells()))
    return false;
  const Column<std::uint32_t>& first = index.first_star;
  return first.size() == index.first_cell[band_count] + std::size_t(1) && first[0] == 0 &&
         first[first.size() - 1] == stars && std::ranges::is_sorted(first) &&
         index.direction.size() == stars;
}

void query_cone(std::span<const float> v_mag, const StarIndex& index, const Vec<Gcrs>& axis,
                double radius_rad, double faintest_v_mag, std::vector<std::uint32_t>& found) {
  if (!(radius_rad >= 0)) return;
  const auto [ra, dec] = to_spherical(axis);
  // By the chord: the cosine loses arcseconds in narrow cones.
  const double half = std::sin(0.5 * std::min(radius_rad, pi));
  const double chord2 = radius_rad >= pi ? 5.0 : 4 * half * half;
  const double margin = 1e-9;  // cells are chosen a little wider than the cone
  const double low = dec - radius_rad - margin, high = dec + radius_rad + margin;
  const bool holds_pole = low <= -pi / 2 || high >= pi / 2;
  // A cone without a pole spans asin(sin r / cos dec) of right ascension to either side.
  const double ratio = std::sin(std::min(radius_rad + margin, pi / 2)) / std::cos(dec);
  const double half_ra = holds_pole || ratio >= 1 ? pi : std::asin(ratio) + margin;
  // The cells `from`..`to` of a band lie together, and so do their stars.
  const auto take = [&](std::uint32_t first, std::int64_t from, std::int64_t to) {
    for (std::int64_t k = from; k <= to; ++k) {
      const std::uint32_t cell = first + std::uint32_t(k);
      for (std::uint32_t i = index.first_star[cell]; i < index.first_star[cell + 1]; ++i) {
        if (double(v_mag[i]) > faintest_v_mag) break;  // brightest first
        const Vec<Gcrs> apart = index.direction[i] - axis;
        if (dot(apart, apart) <= chord2) found.push_back(i);
      }
    }
  };
  for (int b = band_of(low); b <= band_of(high); ++b) {
    const std::uint32_t first = index.first_cell[b];
    const auto cells = std::int64_t(index.first_cell[b + 1] - first);
    const double per_rad = double(cells) / (2 * pi);
    const auto from = std::int64_t(std::floor((ra - half_ra) * per_rad));
    const auto to = std::int64_t(std::floor((ra + half_ra) * per_rad));
    if (to - from + 1 >= cells) {
      take(first, 0, cells - 1);
    } else if (from < 0) {  // through 0 h
      take(first, 0, to);
      take(first, from + cells, cells - 1);
    } else if (to >= cells) {
      take(first, 0, to - cells);
      take(first, from, cells - 1);
    } else {
      take(first, from, to);
    }
  }
}

}  // namespace dmise
