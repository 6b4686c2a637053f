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

double variance_of(const Source& source, TrailParameter parameter) {
  const int at = std::popcount(source.free & (unsigned(parameter) - 1));
  return source.fit.cov(at, at);
}

std::optional<StreakMotion> motion_of(const Source& source) {
  const bool is_line = (source.free & trail_length) && (source.free & trail_angle);
  if (!source.streak || !is_line || source.at_edge || source.beside || source.flashes > 0 ||
      source.broad_sigma_px > 0.0)
    return std::nullopt;
  const Trail& t = source.trail();
  auto out = streak_motion(t, variance_of(source, trail_length), variance_of(source, trail_angle));
  if (out && (source.free & trail_sagitta))
    out->bend = {t.sagitta_px, variance_of(source, trail_sagitta) + floor_px * floor_px};
  return out;
}

/// Angle between two lines.
double turn_rad(const StreakMotion& a, const StreakMotion& b) {
  return std::remainder(a.angle_rad - b.angle_rad, pi);
}

/// Square of the difference of two lines from end to end, by its error.
double difference2(const StreakMotion& a, const StreakMotion& b) {
  const double length_px = 0.5 * (a.length_px + b.length_px);
  const double along = a.length_px - b.length_px,
               across = 2 * std::sin(0.5 * turn_rad(a, b)) * length_px;
  return along * along / (a.along_px2 + b.along_px2) +
         across * across / (a.across_px2 + b.across_px2);
}

bool are_alike(const StreakMotion& a, const StreakMotion& b) {
  constexpr double most2 = tolerance_sigmas * tolerance_sigmas;
  if (difference2(a, b) > most2) return false;
  if (!a.bend || !b.bend) return true;
  // The side to which a line bends changes its sign with the line's direction.
  const double sign = std::cos(a.angle_rad - b.angle_rad) < 0 ? -1.0 : 1.0;
  const double apart = a.bend->first - sign * b.bend->first;
  return apart * apart < most2 * (a.bend->second + b.bend->second);
}

/// Chance that a streak of any direction, and of a length up to some twice that of another, agrees
/// with it as well as one does.
double chance_of(const StreakMotion& a, const StreakMotion& b) {
  const double along_px = std::sqrt(a.along_px2 + b.along_px2),
               across_px = std::sqrt(a.across_px2 + b.across_px2);
  return std::min(1.0, 2 * difference2(a, b) * along_px * across_px / (a.length_px * a.length_px));
}

double log_of_choices(std::size_t of, std::size_t count) {
  return std::lgamma(double(of) + 1) - std::lgamma(double(count) + 1) -
         std::lgamma(double(of - count) + 1);
}

/// Logarithm of the chance that of `of` streaks without relation so many agree so well with one as
/// the best of some do. `chances`: of each of these alone.
double log_chance_of(std::vector<double> chances, std::size_t of) {
  std::ranges::sort(chances);
  double best = HUGE_VAL;
  for (std::size_t k = min_alike - 1; k <= chances.size(); ++k)
    best = std::min(best,
                    log_of_choices(of, k) + double(k) * std::log(std::max(chances[k - 1], 1e-300)));
  return best + std::log(double(of) + 1.0);  // so many numbers were tried
}

/// Streaks that agree with one.
struct Group {
  std::vector<StreakMotion> streaks;
  double log_chance = HUGE_VAL;
};

Group group_of(const StreakMotion& one, std::span<const StreakMotion> all) {
  Group out;
  std::vector<double> chances;
  for (const StreakMotion& other : all) {
    if (!are_alike(one, other)) continue;
    out.streaks.push_back(other);
    if (&other != &one) chances.push_back(chance_of(one, other));
  }
  out.log_chance = std::log(double(all.size())) + log_chance_of(std::move(chances), all.size() - 1);
  return out;
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

std::optional<StreakMotion> streak_motion(const Trail& trail, double length_px2,
                                          double angle_rad2) {
  const double length2 = trail.length_px * trail.length_px;
  const double floor2 = floor_px * floor_px + floor_share * floor_share * length2;
  const StreakMotion out{.middle = {trail.x_px, trail.y_px},
                         .length_px = trail.length_px,
                         .angle_rad = trail.angle_rad,
                         .along_px2 = length_px2 + floor2,
                         .across_px2 = angle_rad2 * length2 + floor2,
                         .bend = std::nullopt};
  const double most2 = vague_share * vague_share * length2 + floor2;
  if (!(trail.length_px > 0) || !(out.along_px2 <= most2) || !(out.across_px2 <= most2))
    return std::nullopt;
  return out;
}

std::optional<AlikeStreaks> alike_motions(std::span<const StreakMotion> streaks) {
  Group best;
  for (const StreakMotion& one : streaks)
    if (Group group = group_of(one, streaks); group.log_chance < best.log_chance)
      best = std::move(group);
  if (best.streaks.size() < min_alike || best.log_chance > std::log(max_chance) ||
      are_in_row(best.streaks))
    return std::nullopt;
  return AlikeStreaks{mean_trail(best.streaks), best.streaks.size()};
}

std::optional<AlikeStreaks> alike_streaks(std::span<const Source> sources) {
  std::vector<StreakMotion> streaks;
  for (const Source& source : sources)
    if (const auto motion = motion_of(source); motion && streaks.size() < max_compared)
      streaks.push_back(*motion);
  return alike_motions(streaks);
}

}  // namespace dmise
