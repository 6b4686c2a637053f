#include "core/detection/stars/alike_streaks.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/units.h"

namespace dmise {
namespace {

constexpr std::size_t min_alike = 3, max_compared = 500;
constexpr double tolerance_sigmas = 3.5;
constexpr double floor_px = 0.5, floor_share = 0.01;  // error of a star's trail that is not its own
constexpr double vague_share = 0.2;  // error of a length, of it, with which it says little
constexpr double max_chance = 1e-3;  // expected groups as large, of streaks that have no relation
constexpr double row_share = 0.05;   // scatter beside a row, of that along it

/// What a fitted streak says of its motion: errors are along and across it.
struct StreakMotion {
  PixelPosition middle;
  double length_px = 0.0, angle_rad = 0.0;
  double along_px2 = 0.0, across_px2 = 0.0;
  std::optional<std::pair<double, double>> bend;  // sagitta and its variance
};

double variance_of(const Source& source, TrailParameter parameter) {
  const int at = std::popcount(source.free & (unsigned(parameter) - 1));
  return source.fit.cov(at, at);
}

/// Empty if a source says little of a star's motion.
std::optional<StreakMotion> motion_of(const Source& source) {
  const Trail& t = source.trail();
  const bool is_line = (source.free & trail_length) && (source.free & trail_angle);
  if (!source.streak || !is_line || source.at_edge || source.beside || source.flashes > 0 ||
      source.broad_sigma_px > 0.0 || !(t.length_px > 0))
    return std::nullopt;
  const double floor2 = std::pow(floor_px, 2) + std::pow(floor_share * t.length_px, 2);
  StreakMotion out{
      .middle = {t.x_px, t.y_px},
      .length_px = t.length_px,
      .angle_rad = t.angle_rad,
      .along_px2 = variance_of(source, trail_length) + floor2,
      .across_px2 = variance_of(source, trail_angle) * t.length_px * t.length_px + floor2,
      .bend = std::nullopt};
  if (std::max(out.along_px2, out.across_px2) > std::pow(vague_share * t.length_px, 2) + floor2)
    return std::nullopt;
  if (source.free & trail_sagitta)
    out.bend = {t.sagitta_px, variance_of(source, trail_sagitta) + floor_px * floor_px};
  return out;
}

/// Angle between two lines.
double turn_rad(const StreakMotion& a, const StreakMotion& b) {
  return std::remainder(a.angle_rad - b.angle_rad, pi);
}

bool are_alike(const StreakMotion& a, const StreakMotion& b) {
  constexpr double most2 = tolerance_sigmas * tolerance_sigmas;
  const double turn = turn_rad(a, b), length_px = 0.5 * (a.length_px + b.length_px);
  const double along = a.length_px - b.length_px, across = 2 * std::sin(0.5 * turn) * length_px;
  if (along * along / (a.along_px2 + b.along_px2) +
          across * across / (a.across_px2 + b.across_px2) >
      most2)
    return false;
  if (!a.bend || !b.bend) return true;
  // The side to which a line bends changes its sign with the line's direction.
  const double sign = std::cos(a.angle_rad - b.angle_rad) < 0 ? -1.0 : 1.0;
  const double apart = a.bend->first - sign * b.bend->first;
  return apart * apart < most2 * (a.bend->second + b.bend->second);
}

/// Chance that a streak of any direction, and of a length up to some twice that of another, agrees
/// with it.
double chance_of(const StreakMotion& a, const StreakMotion& b) {
  const double along_px = std::sqrt(a.along_px2 + b.along_px2),
               across_px = std::sqrt(a.across_px2 + b.across_px2);
  return std::min(1.0, 2 * std::pow(tolerance_sigmas / a.length_px, 2) * along_px * across_px);
}

double log_of_choices(std::size_t of, std::size_t count) {
  return std::lgamma(double(of) + 1) - std::lgamma(double(count) + 1) -
         std::lgamma(double(of - count) + 1);
}

/// Whether middles lie on a line.
bool are_in_row(std::span<const StreakMotion> streaks) {
  const auto n = double(streaks.size());
  PixelPosition mean;
  for (const StreakMotion& s : streaks) mean = mean + s.middle * (1 / n);
  double xx = 0.0, xy = 0.0, yy = 0.0;
  for (const StreakMotion& s : streaks) {
    const PixelPosition d = s.middle - mean;
    xx += d.x_px * d.x_px, xy += d.x_px * d.y_px, yy += d.y_px * d.y_px;
  }
  const double half = std::hypot(0.5 * (xx - yy), xy), middle = 0.5 * (xx + yy);
  return middle - half < row_share * row_share * (middle + half);
}

/// Mean from end to end, by the streaks' errors.
PixelPosition mean_trail(std::span<const StreakMotion> streaks) {
  const StreakMotion& first = streaks.front();
  double length = 0.0, turn = 0.0, of_length = 0.0, of_turn = 0.0;
  for (const StreakMotion& s : streaks) {
    length += s.length_px / s.along_px2, of_length += 1 / s.along_px2;
    turn += turn_rad(s, first) / s.across_px2, of_turn += 1 / s.across_px2;
  }
  const double length_px = length / of_length, angle_rad = first.angle_rad + turn / of_turn;
  return {length_px * std::cos(angle_rad), length_px * std::sin(angle_rad)};
}

}  // namespace

std::optional<AlikeStreaks> alike_streaks(std::span<const Source> sources) {
  std::vector<StreakMotion> streaks;
  for (const Source& source : sources)
    if (const auto motion = motion_of(source); motion && streaks.size() < max_compared)
      streaks.push_back(*motion);
  std::vector<StreakMotion> most;
  double log_chance = 0.0;
  for (const StreakMotion& one : streaks) {
    std::vector<StreakMotion> group;
    double log_agreement = 0.0;
    for (const StreakMotion& other : streaks) {
      if (!are_alike(one, other)) continue;
      group.push_back(other);
      if (&other != &one) log_agreement += std::log(chance_of(one, other));
    }
    if (group.size() <= most.size()) continue;
    most = std::move(group);
    log_chance = std::log(double(streaks.size())) +
                 log_of_choices(streaks.size() - 1, most.size() - 1) + log_agreement;
  }
  if (most.size() < min_alike || log_chance > std::log(max_chance) || are_in_row(most))
    return std::nullopt;
  return AlikeStreaks{mean_trail(most), most.size()};
}

}  // namespace dmise
