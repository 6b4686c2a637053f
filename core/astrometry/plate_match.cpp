#include "core/astrometry/plate_match.h"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/base/units.h"

namespace dmise {
namespace {

/// Share of the catalogue's stars in a frame that are found; the rest are in clouds, in blends, or
/// behind what stands in front.
constexpr double expected_share = 0.6;
constexpr double min_sigma_px = 0.1;

bool in_frame(PixelPosition p, int columns, int rows) {
  return p.x_px >= -0.5 && p.y_px >= -0.5 && p.x_px < columns - 0.5 && p.y_px < rows - 0.5;
}

}  // namespace

SourceGrid::SourceGrid(std::span<const PlateSource> sources, int columns, int rows)
    : sources_(sources) {
  const double area = double(columns) * rows;
  cell_px_ = std::max(1.0, std::sqrt(area / double(sources.size() + 1)));
  columns_ = int(columns / cell_px_) + 1;
  rows_ = int(rows / cell_px_) + 1;
  const auto cell = [&](const PlateSource& s) {
    const int i = std::clamp(int(s.x_px / cell_px_), 0, columns_ - 1);
    const int j = std::clamp(int(s.y_px / cell_px_), 0, rows_ - 1);
    return std::size_t(j * columns_ + i);
  };
  first_.assign(std::size_t(columns_ * rows_) + 1, 0);
  for (const PlateSource& s : sources) ++first_[cell(s) + 1];
  std::partial_sum(first_.begin(), first_.end(), first_.begin());
  order_.resize(sources.size());
  std::vector<std::uint32_t> next(first_.begin(), first_.end() - 1);
  for (std::size_t k = 0; k < sources.size(); ++k)
    order_[next[cell(sources[k])]++] = std::uint32_t(k);
}

int SourceGrid::nearest(PixelPosition at, double within_px) const {
  const auto cell = [&](double px, int cells) {
    return int(std::clamp(std::floor(px / cell_px_), 0.0, double(cells - 1)));
  };
  int best = -1;
  double best2 = within_px * within_px;
  for (int j = cell(at.y_px - within_px, rows_); j <= cell(at.y_px + within_px, rows_); ++j) {
    const auto from = std::size_t(j * columns_ + cell(at.x_px - within_px, columns_));
    const auto to = std::size_t(j * columns_ + cell(at.x_px + within_px, columns_));
    for (std::uint32_t k = first_[from]; k < first_[to + 1]; ++k) {
      const PlateSource& s = sources_[order_[k]];
      const double dx = s.x_px - at.x_px, dy = s.y_px - at.y_px, d2 = dx * dx + dy * dy;
      if (d2 <= best2) {
        best2 = d2;
        best = int(order_[k]);
      }
    }
  }
  return best;
}

double MatchReach::at(PixelPosition place) const {
  const double distance = std::hypot(place.x_px - from.x_px, place.y_px - from.y_px);
  if (distance > max_px) return -1.0;
  return near_px + growth * std::max(0.0, distance - known_px);
}

std::vector<PlateMatch> match(const PlateModel& model, std::span<const SeenStar> stars,
                              std::span<const PlateSource> sources, const SourceGrid& grid,
                              int columns, int rows, const MatchReach& reach) {
  std::vector<PlateMatch> pairs;
  std::vector<std::pair<int, double>> owner(sources.size(), {-1, 0.0});  // pair, distance
  for (std::size_t i = 0; i < stars.size(); ++i) {
    const auto at = model.pixel(stars[i].direction);
    if (!at || !in_frame(*at, columns, rows)) continue;
    const double within = reach.at(*at);
    if (within < 0) continue;
    const int k = grid.nearest(*at, within);
    if (k < 0) continue;
    const PlateSource& s = sources[std::size_t(k)];
    const double distance = std::hypot(s.x_px - at->x_px, s.y_px - at->y_px);
    auto& [pair, nearest] = owner[std::size_t(k)];
    if (pair >= 0 && nearest <= distance) continue;
    nearest = distance;
    const PlateMatch found{.source = std::uint32_t(k),
                           .star = std::uint32_t(i),
                           .pixel = {s.x_px, s.y_px},
                           .covariance_px2 = s.covariance_px2,
                           .direction = stars[i].direction};
    if (pair >= 0) {
      pairs[std::size_t(pair)] = found;
    } else {
      pair = int(pairs.size());
      pairs.push_back(found);
    }
  }
  return pairs;
}

double log_odds(const PlateModel& model, std::span<const SeenStar> stars, const PlateFit& fit,
                std::span<const PlateMatch> pairs, std::size_t sources, int columns, int rows) {
  std::vector<char> hit(stars.size(), 0);
  for (std::size_t k = 0; k < pairs.size(); ++k)
    if (fit.used[k] || pairs[k].ignored) hit[pairs[k].star] = 1;
  const double sigma = std::max(min_sigma_px, fit.rms_px / std::sqrt(2.0));
  const double density = double(sources) / (double(columns) * rows);
  // A hit by a normal distribution of its residual: 1 is the mean of its square in two dimensions.
  const double for_hit = std::log(expected_share / (2 * pi * sigma * sigma * density)) - 1;
  const double for_miss = std::log(1 - expected_share);
  double sum = 0.0, most = 0.0, free = 0.5 * fit.free.size();
  for (std::size_t i = 0; i < stars.size(); ++i) {
    if (hit[i]) {
      const double counts = std::clamp(1 - free, 0.0, 1.0);
      free -= 1;
      sum += counts * for_hit;
    } else if (const auto at = model.pixel(stars[i].direction);
               at && in_frame(*at, columns, rows)) {
      sum += for_miss;
    }
    most = std::max(most, sum);
  }
  return most;
}

}  // namespace dmise
