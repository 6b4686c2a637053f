#include "core/sky/stars/synthetic_stars.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include "core/base/numeric/rng.h"
#include "core/base/units.h"
#include "core/frames/sky_frames.h"
#include "core/sky/stars/sphere_cells.h"
#include "core/sky/stars/star_counts.h"

namespace dmise {
namespace {

/// Fainter stars lie in smaller cells, so that a narrow field makes few that it does not see.
struct Tier {
  double to_v_mag;
  int bands;
};
constexpr std::array<Tier, 3> tiers = {Tier{14.0, 90}, Tier{17.0, 360}, Tier{25.0, 1440}};

/// In wider fields stars are expected by the cells of bright stars alone: 1 % of the count, as the
/// field's edge cuts more of them.
constexpr double widest_fine_rad = 3.0 * deg;

/// Seed of all synthetic skies, whatever the run's seed is.
constexpr std::uint64_t sky_seed = 0x73796e7468657469;

const SphereCells& cells_of(std::size_t tier) {
  static const std::array<SphereCells, tiers.size()> cells = {
      SphereCells(tiers[0].bands), SphereCells(tiers[1].bands), SphereCells(tiers[2].bands)};
  return cells[tier];
}

double square_degrees(const SphereCells::Cell& cell) { return cell.area_sr() / (deg * deg); }

/// A Poisson deviate of a mean: by its distribution function, above 64 as a normal one.
std::uint32_t poisson(double mean, const std::array<std::uint32_t, 4>& words) {
  if (!(mean > 0.0)) return 0;
  if (mean > 64.0) {
    const double drawn = mean + std::sqrt(mean) * double(normal_of(words[0])) + 0.5;
    return std::uint32_t(std::max(0.0, std::floor(drawn)));
  }
  const double u = uniform_of(words[0]);
  double term = std::exp(-mean), sum = term;
  std::uint32_t k = 0;
  while (u > sum && k < 200) sum += term *= mean / double(++k);
  return k;
}

/// B-V of a star. Bahcall & Soneira 1980 have two peaks: stars at the turn-off of the main
/// sequence, and red dwarfs, whose share grows with the magnitude; dust reddens those of the Milky
/// Way.
double draw_bv(double v_mag, double sin_latitude, std::uint32_t which, std::uint32_t deviate) {
  const double red_share = std::clamp(0.15 + 0.05 * (v_mag - 12.0), 0.15, 0.5);
  const double reddening =
      0.3 * std::exp(-std::abs(sin_latitude) / 0.1) * std::clamp((v_mag - 9.0) / 6.0, 0.0, 1.0);
  const bool is_red = uniform_of(which) < red_share;
  const double z = double(normal_of(deviate));
  return std::clamp((is_red ? 1.3 + 0.15 * z : 0.62 + 0.2 * z) + reddening, -0.3, 2.0);
}

}  // namespace

SyntheticStars::SyntheticStars(std::shared_ptr<const StarMap> catalogue, double catalogue_to_v_mag,
                               double to_v_mag)
    : catalogue_(std::move(catalogue)),
      catalogue_to_v_mag_(catalogue_to_v_mag),
      from_v_mag_(StarCounts::first_v_mag),
      to_v_mag_(to_v_mag) {
  if (!catalogue_) return;
  const double complete = std::min(catalogue_to_v_mag, catalogue_->summary.faintest_filled_v_mag);
  from_v_mag_ = std::max(0.0, bin_mag * std::floor(complete / bin_mag));
}

SyntheticStars::Missing SyntheticStars::count_missing(std::uint32_t number) const {
  Missing missing;
  missing.fill(1.0F);
  if (!catalogue_) return missing;
  const SphereCells& cells = cells_of(0);
  const SphereCells::Cell cell = cells.cell(number);
  std::vector<std::uint32_t> found;
  query_cone(*catalogue_, cell.middle, cells.half_rad(), catalogue_to_v_mag_, found);
  std::array<double, max_bins> count{};
  for (const std::uint32_t star : found) {
    const double bin = std::floor((catalogue_->stars.v_mag[star] - from_v_mag_) / bin_mag);
    if (bin < 0.0 || bin >= double(max_bins) ||
        cells.at(catalogue_->index.direction[star]) != number)
      continue;
    ++count[std::size_t(bin)];
  }
  const StarCounts counts(galactic_from_gcrs() * cell.middle);
  for (std::size_t bin = 0; bin < max_bins; ++bin) {
    const double from = from_v_mag_ + bin_mag * double(bin);
    const double mean =
        (counts.brighter_than(from + bin_mag) - counts.brighter_than(from)) * square_degrees(cell);
    missing[bin] = float(std::clamp(1.0 - count[bin] / mean, 0.0, 1.0));
  }
  return missing;
}

const SyntheticStars::Missing& SyntheticStars::missing_at(const Vec<Gcrs>& direction) const {
  const std::uint32_t cell = cells_of(0).at(direction);
  const std::scoped_lock lock(mutex_);
  const auto known = missing_.find(cell);
  if (known != missing_.end()) return known->second;
  return missing_.emplace(cell, count_missing(cell)).first->second;
}

namespace {

/// Calls `use(tier, cell, counts, missing)` for the cells of a part of the sky, tier by tier.
template <class Use>
void for_cells(const Vec<Gcrs>& axis, double radius_rad, double from_v_mag, double to_v_mag,
               Use&& use) {
  const Rotation<Galactic, Gcrs> galactic = galactic_from_gcrs();
  double tier_from = -std::numeric_limits<double>::infinity();
  for (std::size_t t = 0; t < tiers.size(); ++t) {
    const double from = std::max(from_v_mag, tier_from), to = std::min(to_v_mag, tiers[t].to_v_mag);
    tier_from = tiers[t].to_v_mag;
    if (from >= to) continue;
    for (const auto& [first, last] : cells_of(t).around(axis, radius_rad))
      for (std::uint32_t number = first; number <= last; ++number) {
        const SphereCells::Cell cell = cells_of(t).cell(number);
        use(t, cell, StarCounts(galactic * cell.middle), from, to);
      }
  }
}

}  // namespace

SyntheticStars::Stars SyntheticStars::around(const Vec<Gcrs>& axis, double radius_rad,
                                             double faintest_v_mag) const {
  Stars all;
  const auto append = [](auto& to, const auto& from) {
    to.insert(to.end(), from.begin(), from.end());
  };
  visit(axis, radius_rad, faintest_v_mag, [&](const Stars& some) {
    append(all.direction, some.direction), append(all.id, some.id);
    append(all.v_mag, some.v_mag), append(all.bv, some.bv);
  });
  return all;
}

void SyntheticStars::visit(const Vec<Gcrs>& axis, double radius_rad, double faintest_v_mag,
                           const std::function<void(const Stars&)>& use) const {
  Stars stars;
  for_cells(
      axis, radius_rad, from_v_mag_, std::min(to_v_mag_, faintest_v_mag),
      [&](std::size_t tier, const SphereCells::Cell& cell, const StarCounts& counts, double from,
          double to) {
        const Missing& missing = missing_at(cell.middle);
        const RngKey key = rng_key(sky_seed, "", std::uint32_t(tier) << 28 | cell.number, "stars");
        const double sin_latitude = (galactic_from_gcrs() * cell.middle).z;
        for (double bright = from; bright < to; bright += bin_mag) {
          const auto bin = std::size_t(std::lround((bright - from_v_mag_) / bin_mag));
          if (bin >= max_bins) break;
          // The whole bin is drawn, so that brighter stars are the same for every limit.
          const double faint = bright + bin_mag;
          const auto draw = std::uint32_t(2.0 * bright + 0.5);
          const double mean = (counts.brighter_than(faint) - counts.brighter_than(bright)) *
                              square_degrees(cell) * double(missing[bin]);
          constexpr std::uint32_t none = 0xffffffff;
          const std::uint32_t count = poisson(mean, rng_block(key, none, draw));
          std::vector<std::pair<double, std::uint32_t>> by_brightness;
          for (std::uint32_t k = 0; k < count; ++k) {
            const double v_mag =
                counts.magnitude_of(bright, faint, uniform_of(rng_block(key, k, draw)[0]));
            if (v_mag < to) by_brightness.emplace_back(v_mag, k);
          }
          std::sort(by_brightness.begin(), by_brightness.end());
          for (const auto& [v_mag, k] : by_brightness) {
            const auto words = rng_block(key, k, draw);
            const auto colour = rng_block(key, k, draw + 1024);
            const double ra = cell.ra_rad + cell.width_rad * uniform_of(words[1]);
            const double z =
                cell.low_sine + (cell.high_sine - cell.low_sine) * uniform_of(words[2]);
            const double level = std::sqrt(std::max(0.0, 1.0 - z * z));
            stars.direction.push_back({level * std::cos(ra), level * std::sin(ra), z});
            // 2 bits of tier, 24 of cell, 6 of half magnitude, 31 of place.
            stars.id.push_back(synthetic_star_bit | std::uint64_t(tier) << 61 |
                               std::uint64_t(cell.number) << 37 | std::uint64_t(draw) << 31 | k);
            stars.v_mag.push_back(float(v_mag));
            stars.bv.push_back(float(draw_bv(v_mag, sin_latitude, colour[0], colour[1])));
          }
          if (stars.id.size() < stars_at_a_time) continue;
          use(stars);
          stars.direction.clear(), stars.id.clear(), stars.v_mag.clear(), stars.bv.clear();
        }
      });
  if (!stars.id.empty()) use(stars);
}

double SyntheticStars::expected_around(const Vec<Gcrs>& axis, double radius_rad,
                                       double faintest_v_mag) const {
  double sum = 0.0;
  const double limit = std::min(to_v_mag_, faintest_v_mag);
  const auto add = [&](const SphereCells::Cell& cell, const StarCounts& counts, double from,
                       double to) {
    sum += (counts.brighter_than(to) - counts.brighter_than(from)) * square_degrees(cell);
  };
  if (radius_rad < widest_fine_rad) {
    for_cells(axis, radius_rad, from_v_mag_, limit,
              [&](std::size_t, const SphereCells::Cell& cell, const StarCounts& counts, double from,
                  double to) { add(cell, counts, from, to); });
  } else if (from_v_mag_ < limit) {
    const Rotation<Galactic, Gcrs> galactic = galactic_from_gcrs();
    for (const auto& [first, last] : cells_of(0).around(axis, radius_rad))
      for (std::uint32_t number = first; number <= last; ++number) {
        const SphereCells::Cell cell = cells_of(0).cell(number);
        add(cell, StarCounts(galactic * cell.middle), from_v_mag_, limit);
      }
  }
  return sum;
}

double SyntheticStars::per_square_degree(const Vec<Gcrs>& direction, double faintest_v_mag) const {
  const double limit = std::min(to_v_mag_, faintest_v_mag);
  if (!(from_v_mag_ < limit)) return 0.0;
  const StarCounts counts(galactic_from_gcrs() * direction);
  return counts.brighter_than(limit) - counts.brighter_than(from_v_mag_);
}

}  // namespace dmise
