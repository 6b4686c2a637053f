#include "core/detection/stars/common_trail.h"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>
#include <vector>

#include "core/base/numeric/quantile.h"
#include "core/detection/source/point_snr.h"

namespace dmise {
namespace {

// Limit of slopes [SNR/px times the filter's width], so that no star counts for more. Neither
// brightness nor the whole slope is limited: a limit is reached beyond the end of a bright star.
constexpr float steepest = 6.0F;
constexpr double min_coherence = 0.25;  // edges' agreement; 0: all directions are equally frequent
constexpr double min_share = 0.12;      // beginnings of light that have an end, over all
constexpr double min_scatters = 8.0;
constexpr double shortest_common_sigmas = 5.0, longest_common_px = 400.0;
constexpr std::size_t max_beginnings = 4000;

/// Slopes of SNR along a direction.
using SlopeImage = Image<float, struct SlopeCarrier>;

/// Three times that of noise through the filter.
float min_slope(double sigma_px) { return float(3.0 / (std::sqrt(2.0) * sigma_px)); }

/// Slopes of a frame's SNR of points where they exceed noise.
class Slopes {
 public:
  explicit Slopes(const Scene& scene)
      : snr_(point_snr(scene)),
        least_(min_slope(scene.sigma_px)),
        most_(steepest / float(scene.sigma_px)) {}

  /// Direction along which most edges run; empty if they run in all.
  std::optional<double> direction_rad() const {
    double plus = 0.0, cross = 0.0, all = 0.0;
    for_each([&](int, int, float by_x, float by_y) {
      const auto square = double(by_x * by_x + by_y * by_y);
      const double weight = std::min(1.0, double(most_ * most_) / square);
      plus += weight * double(by_x * by_x - by_y * by_y);
      cross += weight * double(2 * by_x * by_y);
      all += weight * square;
    });
    if (!(all > 0) || !(std::hypot(plus, cross) >= min_coherence * all)) return std::nullopt;
    return 0.5 * std::atan2(-cross, -plus);
  }

  /// Slopes along a direction; 0 where they are of noise.
  SlopeImage along(double direction_rad) const {
    const auto c = float(std::cos(direction_rad)), s = float(std::sin(direction_rad));
    SlopeImage out(snr_.columns, snr_.rows);
    for_each([&](int x, int y, float by_x, float by_y) {
      out.at(x, y) = std::clamp(c * by_x + s * by_y, -most_, most_);
    });
    return out;
  }

 private:
  template <class Visit>
  void for_each(const Visit& visit) const {
    for (int y = 1; y + 1 < snr_.rows; ++y)
      for (int x = 1; x + 1 < snr_.columns; ++x) {
        const float by_x = 0.5F * (snr_.at(x + 1, y) - snr_.at(x - 1, y));
        const float by_y = 0.5F * (snr_.at(x, y + 1) - snr_.at(x, y - 1));
        if (by_x * by_x + by_y * by_y > least_ * least_) visit(x, y, by_x, by_y);
      }
  }

  PointSnrImage snr_;
  float least_, most_;
};

struct PixelStep {
  int x = 0, y = 0;
};

/// Beginnings of light along a direction, of which the ends are searched.
class Beginnings {
 public:
  Beginnings(SlopeImage slopes, double sigma_px) : slopes_(std::move(slopes)) {
    const float least = min_slope(sigma_px);
    const auto all = std::size_t(
        std::ranges::count_if(slopes_.pixels, [&](float slope) { return slope > least; }));
    const std::size_t every = all / max_beginnings + 1;
    std::size_t seen = 0;
    for (int y = 0; y < slopes_.rows; ++y)
      for (int x = 0; x < slopes_.columns; ++x) {
        const float slope = slopes_.at(x, y);
        if (!(slope > least) || seen++ % every != 0) continue;
        beginnings_.push_back({x, y, slope});
        square_ += double(slope * slope);
      }
  }

  /// Share of the beginnings, by their slopes, of which the end is at a distance.
  double share_at(double dx, double dy) const {
    if (!(square_ > 0)) return 0.0;
    const int ix = int(std::floor(dx)), iy = int(std::floor(dy));
    const auto fx = float(dx - ix), fy = float(dy - iy);
    double sum = 0.0;
    for (const Beginning& e : beginnings_) {
      const int x = e.x + ix, y = e.y + iy;
      if (x < 0 || y < 0 || x + 1 >= slopes_.columns || y + 1 >= slopes_.rows) continue;
      const auto in_row = [&](int row) {
        return (1 - fx) * slopes_.at(x, row) + fx * slopes_.at(x + 1, row);
      };
      const float there = (1 - fy) * in_row(y) + fy * in_row(y + 1);
      sum -= double(e.slope * there);
    }
    return sum / square_;
  }

  /// These shares at many distances of whole pixels, none of which is longer than `reach_px`.
  std::vector<double> shares_at(const std::vector<PixelStep>& distances, int reach_px) const {
    std::vector<float> sums(distances.size(), 0.0F);
    std::vector<std::ptrdiff_t> steps;
    for (const PixelStep& d : distances)
      steps.push_back(std::ptrdiff_t(d.y) * slopes_.columns + d.x);
    for (const Beginning& e : beginnings_) {
      const float* here = &slopes_.at(e.x, e.y);
      if (std::min({e.x, e.y, slopes_.columns - 1 - e.x, slopes_.rows - 1 - e.y}) >= reach_px) {
        for (std::size_t k = 0; k < steps.size(); ++k) sums[k] -= e.slope * here[steps[k]];
        continue;
      }
      for (std::size_t k = 0; k < steps.size(); ++k) {
        const int x = e.x + distances[k].x, y = e.y + distances[k].y;
        if (x >= 0 && y >= 0 && x < slopes_.columns && y < slopes_.rows)
          sums[k] -= e.slope * here[steps[k]];
      }
    }
    std::vector<double> shares;
    for (const float sum : sums) shares.push_back(square_ > 0 ? double(sum) / square_ : 0.0);
    return shares;
  }

 private:
  struct Beginning {
    int x, y;
    float slope;
  };

  SlopeImage slopes_;
  std::vector<Beginning> beginnings_;
  double square_ = 0.0;
};

/// The middle of the peak of shares around a distance.
PixelPosition middle_of_peak(const Beginnings& beginnings, PixelPosition peak) {
  constexpr int reach = 6;
  constexpr double step_px = 0.5;
  for (int round = 0; round < 2; ++round) {
    std::vector<double> shares;
    for (int j = -reach; j <= reach; ++j)
      for (int i = -reach; i <= reach; ++i)
        shares.push_back(beginnings.share_at(peak.x_px + i * step_px, peak.y_px + j * step_px));
    const double floor = 0.5 * *std::ranges::max_element(shares);
    double sum = 0.0, x = 0.0, y = 0.0;
    std::size_t k = 0;
    for (int j = -reach; j <= reach; ++j)
      for (int i = -reach; i <= reach; ++i, ++k) {
        const double weight = std::max(shares[k] - floor, 0.0);
        sum += weight, x += weight * i, y += weight * j;
      }
    if (!(sum > 0)) break;
    peak = peak + PixelPosition{x / sum * step_px, y / sum * step_px};
  }
  return peak;
}

/// Distances around a direction, of trails up to a length.
std::vector<PixelStep> distances_along(double direction_rad, double from_px, double to_px) {
  const double c = std::cos(direction_rad), s = std::sin(direction_rad);
  std::vector<PixelStep> out;
  for (double along = from_px; along < to_px; along += 1.0) {
    const double beside = std::ceil(2 + 0.04 * along);
    for (double across = -beside; across <= beside; across += 1.0)
      out.push_back(
          {int(std::lround(along * c - across * s)), int(std::lround(along * s + across * c))});
  }
  return out;
}

}  // namespace

std::optional<PixelPosition> common_trail(const Scene& scene) {
  const double max_px =
      std::min(longest_common_px, 0.6 * std::min(scene.counts.columns, scene.counts.rows));
  const double min_px = shortest_common_sigmas * std::sqrt(2.0) * scene.sigma_px;
  if (!(min_px < max_px)) return std::nullopt;
  std::optional<Slopes> slopes(scene);
  const auto direction = slopes->direction_rad();
  if (!direction) return std::nullopt;
  SlopeImage along = slopes->along(*direction);
  slopes.reset();
  const Beginnings beginnings(std::move(along), scene.sigma_px);
  const auto distances = distances_along(*direction, min_px, max_px);
  std::vector<double> shares = beginnings.shares_at(distances, int(1.1 * max_px) + 4);
  const auto best = std::ranges::max_element(shares);
  const double most = *best;
  const PixelStep& at = distances[std::size_t(best - shares.begin())];
  const PixelPosition peak{double(at.x), double(at.y)};
  for (double& share : shares) share = std::abs(share);
  if (most < min_share || most < min_scatters * 1.48 * median_of(shares)) return std::nullopt;
  return middle_of_peak(beginnings, peak);
}

}  // namespace dmise
