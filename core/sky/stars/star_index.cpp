#include "core/sky/stars/star_index.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

#include "core/base/units.h"
#include "core/sky/stars/sphere_cells.h"

namespace dmise {
namespace {

/// Bands are 2 degrees wide: some 12 stars a cell with 126,000 stars.
constexpr int min_bands = 90;

constexpr double first_limit = 9.0;
constexpr float no_limit = std::numeric_limits<float>::infinity();

/// Returns `count` tiers without stars: of V = 9 and brighter, of each magnitude, of all fainter
/// ones. The sky has about twice as many stars a magnitude fainter; cells have some 100 stars to V
/// = 16.
std::vector<StarTier> empty_tiers(std::size_t count) {
  std::vector<StarTier> tiers;
  for (std::size_t t = 0; t < count; ++t) {
    const double limit = first_limit + double(t);
    const double finer = std::exp2(0.5 * std::clamp(limit - 11, 0.0, 6.0));
    const bool is_last = t + 1 == count;
    tiers.push_back(
        {.faintest_v_mag = is_last ? no_limit : float(limit), .bands = int(min_bands * finer)});
  }
  return tiers;
}

std::size_t tiers_for(const std::vector<float>& v_mag) {
  if (v_mag.size() <= max_stars_at_once) return 1;
  const double faintest = *std::ranges::max_element(v_mag);
  return std::size_t(std::clamp(std::ceil(faintest) - first_limit + 1, 1.0, 13.0));
}

template <class T>
void reorder(std::vector<T>& values, const std::vector<std::uint32_t>& order) {
  std::vector<T> sorted(values.size());
  for (std::size_t i = 0; i < order.size(); ++i) sorted[i] = values[order[i]];
  values = std::move(sorted);
}

}  // namespace

StarIndex build_star_index(StarCatalogue& c) {
  const std::size_t n = c.size();
  StarIndex index{.tiers = empty_tiers(tiers_for(c.v_mag))};
  std::vector<std::size_t> cells_before{0};  // in the tiers before each, then in all
  for (StarTier& tier : index.tiers) {
    tier.first_cell = first_cells(tier.bands);
    cells_before.push_back(cells_before.back() + tier.first_cell[std::size_t(tier.bands)]);
  }
  std::vector<std::uint32_t> cell(n);
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t t = 0;
    while (c.v_mag[i] > index.tiers[t].faintest_v_mag) ++t;
    const StarTier& tier = index.tiers[t];
    cell[i] = std::uint32_t(cells_before[t]) + cell_at(tier.first_cell, c.ra_rad[i], c.dec_rad[i]);
  }
  std::vector<std::uint32_t> order(n);
  std::iota(order.begin(), order.end(), 0U);
  std::sort(order.begin(), order.end(), [&](std::uint32_t a, std::uint32_t b) {
    if (cell[a] != cell[b]) return cell[a] < cell[b];
    if (c.v_mag[a] != c.v_mag[b]) return c.v_mag[a] < c.v_mag[b];
    return a < b;
  });
  for_columns([&](auto& column) { reorder(column, order); }, c);

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
  for (const auto& [first, last] : cells_around(tier.first_cell, axis, radius_rad))
    for (std::uint32_t cell = first; cell <= last; ++cell) in_cell(tier, cell);
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
