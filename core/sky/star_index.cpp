#include "core/sky/star_index.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/units.h"

namespace dmise {
namespace {

/// Of 2 degrees: some 12 stars a cell with 126,000 stars.
constexpr int least_bands = 90;

constexpr double first_limit = 9.0;
constexpr float no_limit = std::numeric_limits<float>::infinity();

/// So many tiers without stars: of V = 9 and brighter, of each magnitude, of all that is fainter.
/// The sky has about twice as many stars a magnitude fainter; cells have some 100 stars to V = 16.
std::vector<StarTier> empty_tiers(std::size_t count) {
  std::vector<StarTier> tiers;
  for (std::size_t t = 0; t < count; ++t) {
    const double limit = first_limit + double(t);
    const double finer = std::exp2(0.5 * std::clamp(limit - 11, 0.0, 6.0));
    const bool is_last = t + 1 == count;
    tiers.push_back(
        {.faintest_v_mag = is_last ? no_limit : float(limit), .bands = int(least_bands * finer)});
  }
  return tiers;
}

std::size_t tiers_for(const std::vector<float>& v_mag) {
  if (v_mag.size() <= most_stars_at_once) return 1;
  const double faintest = *std::ranges::max_element(v_mag);
  return std::size_t(std::clamp(std::ceil(faintest) - first_limit + 1, 1.0, 13.0));
}

int band_of(double dec_rad, int bands) {
  return std::clamp(int((dec_rad + pi / 2) / (pi / bands)), 0, bands - 1);
}

template <class T>
void reorder(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
  std::vector<T> sorted(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = values[order[i]];
  values = std::move(sorted);
}

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

}  // namespace

StarIndex build_star_index(StarCatalogue& c) {
  const std::size_t n = c.size();
  StarIndex index{.tiers = empty_tiers(tiers_for(c.v_mag))};
  std::vector<std::size_t> cells_before{0};  // of the tiers, through all of them
  for (StarTier& tier : index.tiers) {
    tier.first_cell = first_cells(tier.bands);
    cells_before.push_back(cells_before.back() + tier.first_cell[std::size_t(tier.bands)]);
  }
  std::vector<std::uint32_t> cell(n);
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t t = 0;
    while (c.v_mag[i] > index.tiers[t].faintest_v_mag) ++t;
    const StarTier& tier = index.tiers[t];
    const int b = band_of(c.dec_rad[i], tier.bands);
    const std::uint32_t cells = tier.first_cell[b + 1] - tier.first_cell[b];
    const auto within = std::uint32_t(c.ra_rad[i] / (2 * pi) * cells);
    cell[i] = std::uint32_t(cells_before[t]) + tier.first_cell[b] + std::min(within, cells - 1);
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

  std::vector<std::uint32_t> first_star(cells_before.back() + 1, 0);
  for (const std::uint32_t one : cell) ++first_star[one + 1];
  std::partial_sum(first_star.begin(), first_star.end(), first_star.begin());
  for (std::size_t t = 0; t < index.tiers.size(); ++t)
    index.tiers[t].first_star =
        std::vector(first_star.begin() + std::ptrdiff_t(cells_before[t]),
                    first_star.begin() + std::ptrdiff_t(cells_before[t + 1]) + 1);
  std::vector<Vec<Gcrs>> direction(n);
  for (std::size_t i = 0; i < n; ++i) {
    direction[i] = from_spherical<Gcrs>(c.ra_rad[i], c.dec_rad[i]);
    index.fastest_motion_rad_per_yr =
        std::max(index.fastest_motion_rad_per_yr,
                 std::hypot(c.pm_ra_cosdec_rad_per_yr[i], c.pm_dec_rad_per_yr[i]));
  }
  index.direction = std::move(direction);
  return index;
}

bool is_sound(const StarIndex& index, std::size_t stars) {
  const std::vector<StarTier> tiers = empty_tiers(index.tiers.size());
  if (tiers.empty() || index.direction.size() != stars) return false;
  std::uint32_t next = 0;
  for (std::size_t t = 0; t < tiers.size(); ++t) {
    const StarTier& tier = index.tiers[t];
    if (tier.bands != tiers[t].bands || tier.faintest_v_mag != tiers[t].faintest_v_mag ||
        !std::ranges::equal(tier.first_cell, first_cells(tier.bands)))
      return false;
    const Column<std::uint32_t>& first = tier.first_star;
    if (first.size() != tier.first_cell[std::size_t(tier.bands)] + std::size_t(1) ||
        first[0] != next || !std::ranges::is_sorted(first))
      return false;
    next = first[first.size() - 1];
  }
  return next == stars;
}

namespace {

/// The search in one tier.
struct ConeSearch {
  std::span<const float> v_mag;
  const StarIndex& index;
  const Vec<Gcrs>& axis;
  double radius_rad, faintest_v_mag;
  const StarBlocks* blocks;
  std::vector<std::uint32_t>& found;
  // By the chord: the cosine loses arcseconds in narrow cones.
  double chord2 = radius_rad >= pi ? 5.0 : 4 * square(std::sin(0.5 * std::min(radius_rad, pi)));
  std::uint32_t checked_to = 0;  // the first star beyond what was checked last

  static double square(double x) { return x * x; }
  void in_tier(const StarTier& tier);
  void in_cell(const StarTier& tier, std::uint32_t cell);
};

void ConeSearch::in_cell(const StarTier& tier, std::uint32_t cell) {
  for (std::uint32_t i = tier.first_star[cell]; i < tier.first_star[cell + 1]; ++i) {
    if (blocks && i >= checked_to) checked_to = blocks->check(i);
    if (double(v_mag[i]) > faintest_v_mag) break;  // brightest first
    const Vec<Gcrs> apart = index.direction[i] - axis;
    if (dot(apart, apart) <= chord2) found.push_back(i);
  }
}

void ConeSearch::in_tier(const StarTier& tier) {
  const auto [ra, dec] = to_spherical(axis);
  const double margin = 1e-9;  // cells are chosen a little wider than the cone
  const double low = dec - radius_rad - margin, high = dec + radius_rad + margin;
  const bool holds_pole = low <= -pi / 2 || high >= pi / 2;
  // A cone without a pole spans asin(sin r / cos dec) of right ascension to either side.
  const double ratio = std::sin(std::min(radius_rad + margin, pi / 2)) / std::cos(dec);
  const double half_ra = holds_pole || ratio >= 1 ? pi : std::asin(ratio) + margin;
  // The cells `from`..`to` of a band lie together, and so do their stars.
  const auto take = [&](std::uint32_t first, std::int64_t from, std::int64_t to) {
    for (std::int64_t k = from; k <= to; ++k) in_cell(tier, first + std::uint32_t(k));
  };
  for (int b = band_of(low, tier.bands); b <= band_of(high, tier.bands); ++b) {
    const std::uint32_t first = tier.first_cell[b];
    const auto cells = std::int64_t(tier.first_cell[b + 1] - first);
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

}  // namespace

void query_cone(std::span<const float> v_mag, const StarIndex& index, const Vec<Gcrs>& axis,
                double radius_rad, double faintest_v_mag, std::vector<std::uint32_t>& found,
                const StarBlocks* blocks) {
  if (!(radius_rad >= 0)) return;
  ConeSearch search{v_mag, index, axis, radius_rad, faintest_v_mag, blocks, found};
  double brightest = -std::numeric_limits<double>::infinity();
  for (const StarTier& tier : index.tiers) {
    if (brightest >= faintest_v_mag) break;
    search.in_tier(tier);
    brightest = tier.faintest_v_mag;
  }
}

}  // namespace dmise
