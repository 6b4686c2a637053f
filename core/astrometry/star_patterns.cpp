#include "core/astrometry/star_patterns.h"

#include "core/base/units.h"

namespace dmise {
namespace {

constexpr std::uint32_t none = ~0U;
constexpr double max_stars = 400'000.0, max_fainter = 3'000'000.0;  // in the whole sky
constexpr std::size_t bright_neighbours = 5, fainter_neighbours = 4;

/// The nearest stars that are not fainter, by rising distance.
void nearest_brighter(const PlateSky& sky, std::uint32_t star, std::size_t most,
                      std::vector<std::uint32_t>& near) {
  const StarMap& map = sky.map();
  const Vec<Gcrs>& here = map.index.direction[star];
  const float v_mag = map.stars.v_mag[star];
  const double rank = std::max(1.0, double(sky.brighter_than(v_mag)));
  const auto distance2 = [&](std::uint32_t i) {
    const Vec<Gcrs> apart = map.index.direction[i] - here;
    return dot(apart, apart);
  };
  for (double expected = 2.0 * double(most) + 2;; expected *= 4) {
    const double share = std::min(1.0, expected / rank);
    const double radius_rad = share < 1 ? 2 * std::asin(std::sqrt(share)) : pi;
    near.clear();
    query_cone(map, here, radius_rad, v_mag, near);
    // Companions closer than images resolve are the same source.
    std::erase_if(near, [&](std::uint32_t i) { return i == star || distance2(i) < 1e-10; });
    if (near.size() >= most || share >= 1) break;
  }
  const auto count = std::min(near.size(), most);
  std::partial_sort(near.begin(), near.begin() + std::ptrdiff_t(count), near.end(),
                    [&](std::uint32_t a, std::uint32_t b) {
                      const double da = distance2(a), db = distance2(b);
                      return da != db ? da < db : a < b;
                    });
  near.resize(count);
}

}  // namespace

PatternIndex::PatternIndex(const PlateSky& sky, std::vector<std::uint32_t> stars,
                           std::size_t neighbours, int others)
    : others_(others),
      neighbours_(neighbours),
      stars_(std::move(stars)),
      near_(stars_.size() * neighbours, none),
      first_(std::size_t(bins * bins * bins) + 1, 0) {
  const auto& direction = sky.map().index.direction;
  std::vector<std::uint32_t> near;
  for (std::size_t i = 0; i < stars_.size(); ++i) {
    nearest_brighter(sky, stars_[i], neighbours, near);
    std::copy(near.begin(), near.end(), near_.begin() + std::ptrdiff_t(i * neighbours));
  }
  std::vector<std::complex<double>> places;
  const auto visit_all = [&](const auto& visit) {
    for (std::size_t i = 0; i < stars_.size(); ++i) {
      places.clear();
      for (std::size_t k = 0; k < neighbours; ++k)
        if (const std::uint32_t other = near_[i * neighbours + k]; other != none)
          places.push_back(plane_place(direction[stars_[i]], direction[other]));
      visit_patterns(places, others, [&](const StarPattern& p) {
        visit(Entry{std::uint32_t(i), p});
      });
    }
  };
  visit_all([&](const Entry& e) { ++first_[cell_of(e.pattern) + 1]; });
  for (std::size_t i = 1; i < first_.size(); ++i) first_[i] += first_[i - 1];
  entries_.resize(first_.back());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  visit_all([&](const Entry& e) { entries_[next[cell_of(e.pattern)]++] = e; });
}

std::array<std::uint32_t, 4> PatternIndex::stars_of(const Entry& e) const {
  std::array<std::uint32_t, 4> stars;
  stars.fill(stars_[e.star]);
  for (std::size_t i = 0; i < std::size_t(others_); ++i)
    stars[i + 1] = near_[e.star * neighbours_ + e.pattern.others[i]];
  return stars;
}

const PatternIndex& PatternCache::whole_sky(const PlateSky& sky, double rank) {
  // Powers of 4, so that frames of about the same width share one.
  const double count = double(sky.map().stars.size());
  const double shared =
      std::min({std::exp2(2 * std::ceil(0.5 * std::log2(rank))), max_stars, count});
  const auto kept = by_rank_.find(shared);
  if (kept != by_rank_.end()) return kept->second;
  const auto stars = sky.catalogued({0, 0, 1}, pi, shared);
  return by_rank_.try_emplace(shared, sky, stars, bright_neighbours, 3).first->second;
}

const PatternIndex* PatternCache::fainter(const PlateSky& sky, double rank) {
  const double most = std::min(max_fainter, double(sky.map().stars.size()));
  if (!(std::min(rank, most) > max_stars)) return nullptr;
  if (!fainter_) {
    auto stars = sky.catalogued({0, 0, 1}, pi, most);
    const float brightest = sky.magnitude_of_rank(max_stars);
    std::erase_if(stars, [&](std::uint32_t i) { return sky.map().stars.v_mag[i] < brightest; });
    fainter_.emplace(sky, std::move(stars), fainter_neighbours, 3);
  }
  return &*fainter_;
}

}  // namespace dmise
