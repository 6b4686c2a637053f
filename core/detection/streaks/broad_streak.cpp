#include "core/detection/streaks/broad_streak.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/quantile.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr int max_half_px = 32;        // half of the profile across a line
constexpr double min_broadness = 1.3;  // to the width of the PSF
constexpr double min_pixel_snr = 4.0;

Extent extent_on(const std::vector<Point>& points, const Line& line, double half_px) {
  Extent extent{1, 0};
  for (const Point& p : points) {
    if (std::abs(line.off(p)) > half_px) continue;
    const int at = int(std::lround(line.major(p)));
    extent = extent.to < extent.from ? Extent{at, at}
                                     : Extent{std::min(extent.from, at), std::max(extent.to, at)};
  }
  return extent;
}

/// Median light of pixels along lines beside a line, from `-max_half_px` on; NaN where too few are
/// usable. Each is measured when it is asked for: most lines are narrow.
class ProfileAcross {
 public:
  ProfileAcross(const Scene& scene, const Line& line, const Extent& extent)
      : scene_(scene),
        line_(line),
        seen_(in_frame(scene, line, extent)),
        light_e_(std::size_t(2 * max_half_px + 1)) {}

  int size() const { return int(light_e_.size()); }
  double operator[](int i) {
    auto& light_e = light_e_[std::size_t(i)];
    if (!light_e) light_e = measured(i - max_half_px);
    return *light_e;
  }

 private:
  double measured(int off) {
    constexpr int max_places = 200;
    constexpr std::size_t min_places = 12;
    const int step = std::max(1, (seen_.to - seen_.from) / max_places);
    places_e_.clear();
    for (int k = seen_.from; k <= seen_.to; k += step) {
      const Point at = line_.at(k, off);
      const int x = int(std::lround(at.x)), y = int(std::lround(at.y));
      if (scene_.contains(x, y) && scene_.is_usable(x, y))
        places_e_.push_back(double(scene_.pixel(x, y).signal_e));
    }
    if (places_e_.size() < min_places) return std::nan("");
    return value_of_rank(places_e_, (places_e_.size() - 1) / 2);
  }

  const Scene& scene_;
  Line line_;
  Extent seen_;
  std::vector<std::optional<double>> light_e_;
  std::vector<double> places_e_;  // light along the line that is measured
};

/// What half of a profile's greatest light is between.
struct Sides {
  double first_px = 0.0, last_px = 0.0, max_e = 0.0;
  double width_px() const { return last_px - first_px; }
};

std::optional<Sides> sides_of(ProfileAcross& profile, double reach_px) {
  Sides sides;
  int top = -1;
  for (int i = 0; i < profile.size(); ++i)
    if (std::abs(i - max_half_px) <= reach_px && profile[i] > sides.max_e) {
      sides.max_e = profile[i];
      top = i;
    }
  if (top < 0) return std::nullopt;
  // From outside, because a hollow one may have less than half in its middle.
  const auto side = [&](int way) -> std::optional<double> {
    const double half = 0.5 * sides.max_e;
    std::optional<double> found;
    int dark = 0;
    for (int i = top; i >= 0 && i < profile.size() && dark < 4; i += way) {
      const double here = profile[i];
      if (!std::isfinite(here)) return std::nullopt;
      if (here < half) {
        ++dark;
        continue;
      }
      dark = 0;
      const int next = i + way;
      if (next < 0 || next >= profile.size()) return std::nullopt;
      const double beyond = profile[next];
      if (beyond < half) found = i + way * (here - half) / (here - beyond) - max_half_px;
    }
    return found;
  };
  const auto first = side(-1), last = side(1);
  if (!first || !last) return std::nullopt;
  sides.first_px = *first;
  sides.last_px = *last;
  return sides;
}

/// Standard deviation of a profile's light about its middle.
double spread_px(ProfileAcross& profile, const Sides& sides) {
  const double middle = 0.5 * (sides.first_px + sides.last_px), reach = 1.2 * sides.width_px();
  double sum = 0.0, square = 0.0;
  for (int i = 0; i < profile.size(); ++i) {
    const double off = i - max_half_px - middle;
    if (!(std::abs(off) <= reach)) continue;
    const double light = profile[i];
    if (!(light > 0.1 * sides.max_e)) continue;
    sum += light;
    square += light * off * off;
  }
  return std::sqrt(square / sum);
}

/// Whether there is more light between the sides than two lines of the PSF's width would leave.
bool has_no_gap(ProfileAcross& profile, const Sides& sides, double fwhm_px) {
  constexpr double least_apart = 1.1;   // in FWHM: nearer ones leave no gap
  constexpr double sampling_px2 = 1.0;  // pixels are taken at the nearest place, which widens
  const double apart = sides.width_px() / std::sqrt(fwhm_px * fwhm_px + sampling_px2) - 1;
  if (apart < least_apart) return false;
  const double of_pair = 2 * std::exp2(-apart * apart) / (1 + std::exp2(-4 * apart * apart));
  double min_e = sides.max_e;
  for (int i = int(std::ceil(sides.first_px + fwhm_px / 2));
       i <= int(std::floor(sides.last_px - fwhm_px / 2)); ++i)
    min_e = std::min(min_e, profile[i + max_half_px]);
  return min_e > 0.5 * (1 + of_pair) * sides.max_e;
}

/// Whether there is neither light nor a lack of it beside a line, as there is beside an edge.
bool is_alone(ProfileAcross& profile, const Sides& sides) {
  constexpr double most_beside = 0.2;  // light beside the line, over its peak
  for (const int way : {-1, 1}) {
    const double from = (way < 0 ? sides.first_px : sides.last_px) + way * 0.5 * sides.width_px();
    double sum = 0.0;
    int count = 0;
    for (int k = 0; k < 2 + int(0.5 * sides.width_px()); ++k, ++count) {
      const int i = int(std::lround(from)) + way * k + max_half_px;
      if (i < 0 || i >= profile.size()) return false;
      sum += profile[i];
    }
    if (!(std::abs(sum) < most_beside * count * sides.max_e)) return false;
  }
  return true;
}

}  // namespace

std::optional<BroadLine> broad_line(const Scene& scene, const std::vector<Point>& points,
                                    const Line& rough) {
  constexpr int rounds = 3;
  const double fwhm_px = fwhm_per_sigma * scene.sigma_px;
  BroadLine broad{.line = rough, .extent = {1, 0}};
  double half_px = 4 * fwhm_px;
  for (int round = 0; round < rounds; ++round) {
    broad.line = principal_axis(points, broad.line, half_px);
    broad.extent = extent_on(points, broad.line, half_px);
    if (broad.extent.to <= broad.extent.from) return std::nullopt;
    ProfileAcross profile(scene, broad.line, broad.extent);
    const auto sides = sides_of(profile, half_px);
    if (!sides || sides->width_px() < min_broadness * fwhm_px) return std::nullopt;
    if (sides->max_e < min_pixel_snr * scene.noise_e_at(broad.line.x, broad.line.y))
      return std::nullopt;
    if (!is_alone(profile, *sides)) return std::nullopt;
    const double middle = 0.5 * (sides->first_px + sides->last_px);
    broad.line.x -= middle * broad.line.uy;
    broad.line.y += middle * broad.line.ux;
    broad.sigma_px = 0.5 * (spread_px(profile, *sides) + sides->width_px() / fwhm_per_sigma);
    broad.is_no_pair = has_no_gap(profile, *sides, fwhm_px);
    half_px = 0.75 * sides->width_px() + 2;
  }
  return broad;
}

}  // namespace dmise
