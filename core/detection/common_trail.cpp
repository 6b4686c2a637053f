#include "core/detection/common_trail.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/quantile.h"
#include "core/detection/starlight.h"

namespace dmise {
namespace {

// Of slopes [SNR/px times the filter's width], so that no star counts for more. Neither brightness
// nor the whole slope is limited: a limit is reached beyond the end of a bright star.
constexpr float steepest = 6.0F;
constexpr double least_coherence = 0.25;  // of edges; 0: all directions are equally frequent
constexpr double least_share = 0.12;      // of the beginnings of light that have an end
constexpr double least_scatters = 8.0;
constexpr double shortest_common_sigmas = 5.0, longest_common_px = 400.0;
constexpr std::size_t most_beginnings = 4000;

struct Slope {
  float x = 0.0F, y = 0.0F;
};

/// Slopes of a frame where they exceed noise.
class Slopes {
 public:
  explicit Slopes(const Scene& scene)
      : columns_(scene.counts.columns),
        rows_(scene.counts.rows),
        most_(steepest / float(scene.sigma_px)),
        slopes_(scene.counts.pixels.size()) {
    const Starlight light(scene);
    // Of noise through the filter, and by how much edges exceed it.
    const auto least = float(3.0 / (std::sqrt(2.0) * light.filter_px()));
    const auto at = [&](int x, int y) { return light.snr(x, y); };
    for (int y = 1; y + 1 < rows_; ++y)
      for (int x = 1; x + 1 < columns_; ++x) {
        const Slope s{0.5F * (at(x + 1, y) - at(x - 1, y)), 0.5F * (at(x, y + 1) - at(x, y - 1))};
        if (s.x * s.x + s.y * s.y > least * least) slopes_[index(x, y)] = s;
      }
  }

  /// Direction along which most edges run; empty if they run in all.
  std::optional<double> direction_rad() const {
    double plus = 0.0, cross = 0.0, all = 0.0;
    for (const Slope& s : slopes_) {
      const double square = double(s.x * s.x + s.y * s.y);
      if (square == 0) continue;
      const double weight = std::min(1.0, double(most_ * most_) / square);
      plus += weight * double(s.x * s.x - s.y * s.y);
      cross += weight * double(2 * s.x * s.y);
      all += weight * square;
    }
    if (!(all > 0) || std::hypot(plus, cross) < least_coherence * all) return std::nullopt;
    return 0.5 * std::atan2(-cross, -plus);
  }

  /// Slopes along a direction.
  std::vector<float> along(double direction_rad) const {
    const auto c = float(std::cos(direction_rad)), s = float(std::sin(direction_rad));
    std::vector<float> out;
    out.reserve(slopes_.size());
    for (const Slope& slope : slopes_)
      out.push_back(std::clamp(c * slope.x + s * slope.y, -most_, most_));
    return out;
  }

 private:
  std::size_t index(int x, int y) const {
    return std::size_t(y) * std::size_t(columns_) + std::size_t(x);
  }

  int columns_, rows_;
  float most_;
  std::vector<Slope> slopes_;
};

struct PixelStep {
  int x = 0, y = 0;
};

/// Beginnings of light along a direction, of which the ends are searched.
class Beginnings {
 public:
  Beginnings(const Scene& scene, std::vector<float> slopes)
      : columns_(scene.counts.columns), rows_(scene.counts.rows), slopes_(std::move(slopes)) {
    const auto least = float(3.0 / (std::sqrt(2.0) * scene.sigma_px));
    std::vector<Beginning> all;
    for (int y = 0; y < rows_; ++y)
      for (int x = 0; x < columns_; ++x)
        if (at(x, y) > least) all.push_back({x, y, at(x, y)});
    const std::size_t every = all.size() / most_beginnings + 1;
    for (std::size_t i = 0; i < all.size(); i += every) beginnings_.push_back(all[i]);
    for (const Beginning& e : beginnings_) square_ += double(e.slope * e.slope);
  }

  /// Share of the beginnings, by their slopes, of which the end is at a distance.
  double share_at(double dx, double dy) const {
    if (!(square_ > 0)) return 0.0;
    const int ix = int(std::floor(dx)), iy = int(std::floor(dy));
    const auto fx = float(dx - ix), fy = float(dy - iy);
    double sum = 0.0;
    for (const Beginning& e : beginnings_) {
      const int x = e.x + ix, y = e.y + iy;
      if (x < 0 || y < 0 || x + 1 >= columns_ || y + 1 >= rows_) continue;
      const float there = (1 - fy) * ((1 - fx) * at(x, y) + fx * at(x + 1, y)) +
                          fy * ((1 - fx) * at(x, y + 1) + fx * at(x + 1, y + 1));
      sum -= double(e.slope * there);
    }
    return sum / square_;
  }

  /// The same at many distances of whole pixels, none of which is longer than `reach_px`.
  std::vector<double> shares_at(const std::vector<PixelStep>& distances, int reach_px) const {
    std::vector<float> sums(distances.size(), 0.0F);
    std::vector<std::ptrdiff_t> steps;
    for (const PixelStep& d : distances) steps.push_back(std::ptrdiff_t(d.y) * columns_ + d.x);
    for (const Beginning& e : beginnings_) {
      const float* here = &slopes_[index(e.x, e.y)];
      if (std::min({e.x, e.y, columns_ - 1 - e.x, rows_ - 1 - e.y}) >= reach_px) {
        for (std::size_t k = 0; k < steps.size(); ++k) sums[k] -= e.slope * here[steps[k]];
        continue;
      }
      for (std::size_t k = 0; k < steps.size(); ++k) {
        const int x = e.x + distances[k].x, y = e.y + distances[k].y;
        if (x >= 0 && y >= 0 && x < columns_ && y < rows_) sums[k] -= e.slope * here[steps[k]];
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
  std::size_t index(int x, int y) const {
    return std::size_t(y) * std::size_t(columns_) + std::size_t(x);
  }
  float at(int x, int y) const { return slopes_[index(x, y)]; }

  int columns_, rows_;
  std::vector<float> slopes_;
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
  const Slopes slopes(scene);
  const auto direction = slopes.direction_rad();
  if (!direction) return std::nullopt;
  const Beginnings beginnings(scene, slopes.along(*direction));
  const double most_px =
      std::min(longest_common_px, 0.6 * std::min(scene.counts.columns, scene.counts.rows));
  const auto distances = distances_along(
      *direction, shortest_common_sigmas * std::sqrt(2.0) * scene.sigma_px, most_px);
  if (distances.empty()) return std::nullopt;
  std::vector<double> shares = beginnings.shares_at(distances, int(1.1 * most_px) + 4);
  const auto best = std::ranges::max_element(shares);
  const double most = *best;
  const PixelStep& at = distances[std::size_t(best - shares.begin())];
  const PixelPosition peak{double(at.x), double(at.y)};
  for (double& share : shares) share = std::abs(share);
  if (most < least_share || most < least_scatters * 1.48 * median_of(shares)) return std::nullopt;
  return middle_of_peak(beginnings, peak);
}

}  // namespace dmise
