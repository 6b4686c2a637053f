#include "core/detection/streaks/faint_ends.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/detection/pixels/detection_limits.h"
#include "core/detection/source/line_profile.h"
#include "core/detection/source/source_fit.h"
#include "core/detection/streaks/line_between.h"

namespace dmise {
namespace {

constexpr double min_beyond_px = 24.0;  // beyond an end, where light may be its own
constexpr double negligible = 20.0;     // logarithm of odds
constexpr int turns = 3;                // to each side, by so much at the ends:
constexpr double turn_px = 0.6;
constexpr int max_refits = 3;
constexpr double max_reduced_chi2 = 2.0;
constexpr double worth_a_fit = 6.0;     // logarithm of odds that a better line may gain
constexpr double min_gain = 6.0;        // deviance: by chance, the best of 20 places has 2 ln 20
constexpr double max_residual2 = 16.0;  // that a pixel counts, over its variance

bool has_faint_ends(const Source& source) {
  return source.streak && !source.saturated &&
         source.snr() <
             detection_limits::faint_per_px * std::sqrt(std::max(source.trail().length_px, 4.0));
}

/// Calls visit(line, line between two ends, px^2 of pairs of ends that it stands for) for each
/// pair of ends that is farther apart than the PSF is wide.
template <class Visit>
void for_pairs_of_ends(const Scene& scene, const Source& source, const Visit& visit) {
  const Trail& t = source.trail();
  const bool sloped = (source.free & trail_slope) != 0;
  const double min_px = 3 * scene.sigma_px;
  for (int turn = -turns; turn <= turns; ++turn) {
    Trail line = t;
    line.angle_rad += 2 * turn * turn_px / std::max(t.length_px, 4.0);
    const auto ends = ends_along(scene, line, std::max(min_beyond_px, t.length_px));
    for (std::size_t i = 0; i < ends.size(); ++i)
      for (std::size_t j = i + 1; j < ends.size(); ++j)
        if (ends[j].along_px - ends[i].along_px >= min_px)
          visit(line, LineBetween(ends[i], ends[j], sloped), ends[i].width_px * ends[j].width_px);
  }
}

/// Returns the likeliest trail on these lines with another end than the fit's; empty if it is so
/// unlikely that a fit of it is not worthwhile.
std::optional<Trail> other_ends(const Scene& scene, const Source& source) {
  const Trail& t = source.trail();
  const double near_px = 3 * scene.sigma_px;
  double most = -HUGE_VAL, here = -HUGE_VAL;
  Trail best;
  for_pairs_of_ends(scene, source, [&](const Trail& line, const LineBetween& between, double) {
    const double first_px = between.middle_px() - between.length_px() / 2 + t.length_px / 2;
    const double last_px = between.middle_px() + between.length_px() / 2 - t.length_px / 2;
    const bool is_here = std::max(std::abs(first_px), std::abs(last_px)) < near_px;
    double& odds = is_here ? here : most;
    if (!between.may_exceed(odds)) return;
    const double found = between.log_odds();
    if (!(found > odds)) return;
    odds = found;
    if (is_here) return;
    best = line;
    best.x_px += between.middle_px() * std::cos(line.angle_rad);
    best.y_px += between.middle_px() * std::sin(line.angle_rad);
    best.length_px = between.length_px();
    best.flux_e = between.flux_e();
    best.slope = best.sagitta_px = 0.0;
  });
  if (!(most > here - worth_a_fit)) return std::nullopt;
  return best;
}

/// Returns by how much the deviance of one fit is less than that of another, over the pixels of
/// both.
double gain_over(const Scene& scene, const Source& better, const Source& than) {
  const double margin_px = 3 * scene.sigma_px + 2.5;
  std::vector<FitPixel> pixels = pixels_near(scene, better.trail(), margin_px);
  const Around covered(better.trail(), margin_px);
  for (const FitPixel& p : pixels_near(scene, than.trail(), margin_px))
    if (!covered.has(p.x, p.y)) pixels.push_back(p);
  const auto deviance = [&](const Source& source) {
    const Trail& t = source.trail();
    const auto light = light_in(pixels, {&t, 1}, scene.psf.at({t.x_px, t.y_px}));
    double sum = 0.0;
    for (std::size_t i = 0; i < pixels.size(); ++i) {
      const FitPixel& p = pixels[i];
      const double model = light[i];
      const double variance = p.variance_e2 + std::max(model, 0.0);
      const double residual = p.signal_e - model - source.fit.background_e;
      sum += std::min(residual * residual / variance, max_residual2) + std::log(variance);
    }
    return sum;
  };
  return deviance(than) - deviance(better);
}

/// Returns the least gain of deviance by a fit with other ends. If what is added to a streak or
/// taken from it is as bright as the rest, the gain is the square of its SNR, with twice that SNR
/// as deviation. Light of a gain that is lower by three deviations belongs to something else.
double min_gain_of(const Source& other, const Source& than) {
  const double length_px = std::max(other.trail().length_px, 1.0);
  const double snr =
      other.snr() *
      std::sqrt(std::abs(other.trail().length_px - than.trail().length_px) / length_px);
  return snr * snr - 3 * 2 * snr;
}

/// Whether the middle of one of two fits lies on the other: else they are of different light.
bool are_of_one(const Scene& scene, const Trail& a, const Trail& b) {
  const double margin_px = 3 * scene.sigma_px + 1.5;
  return Around(a, margin_px).has(b.x_px, b.y_px) || Around(b, margin_px).has(a.x_px, a.y_px);
}

/// Whether a new fit lies on one of other streaks that the old one does not lie on. What is shorter
/// than half of it may be a piece of it.
bool reaches_another(const Scene& scene, const Source& now, const Source& before,
                     std::span<const Source> others) {
  const double margin_px = 3 * scene.sigma_px + 1.5, piece_px = before.trail().length_px / 2;
  const Around around_now(now.trail(), margin_px), around_before(before.trail(), margin_px);
  return std::ranges::any_of(others, [&](const Source& other) {
    const Trail& t = other.trail();
    return t.length_px >= piece_px && !around_before.has(t.x_px, t.y_px) &&
           around_now.has(t.x_px, t.y_px);
  });
}

/// The fit without a bend; empty if there is none.
std::optional<Source> straightened(const Scene& scene, const Source& source) {
  Trail straight = source.trail();
  if (straight.sagitta_px == 0.0) return std::nullopt;
  straight.sagitta_px = 0.0;
  return fit_source(scene, straight, true, 0.0, false, source.free & ~unsigned(trail_sagitta));
}

/// A fit of other ends, empty if there is none that is likelier.
std::optional<Source> refitted(const Scene& scene, const Source& source,
                               std::span<const Source> others) {
  std::vector<Source> bases{source};
  if (auto straight = straightened(scene, source)) bases.push_back(std::move(*straight));
  std::optional<Source> best;
  double most = min_gain;
  for (const Source& base : bases) {
    const auto start = other_ends(scene, base);
    if (!start) continue;
    auto other = fit_source(scene, *start, true, 0.0, false, source.free | trail_line);
    if (!other || other->fit.reduced_chi2() > max_reduced_chi2 ||
        other->trail().length_px < 3 * scene.sigma_px)
      continue;
    const Trail& t = other->trail();
    const Line line = line_of(t);
    if (dark_gap(scene, line, extent_of(line, t.length_px / 2), t.flux_e / t.length_px))
      continue;  // behind it is another one
    if (!are_of_one(scene, t, source.trail()) || reaches_another(scene, *other, source, others))
      continue;
    const double gain = gain_over(scene, *other, source);
    if (!(gain > std::max(most, min_gain_of(*other, source)))) continue;
    most = gain;
    best = std::move(other);
  }
  return best;
}

}  // namespace

Source with_likelier_ends(const Scene& scene, Source source, std::span<const Source> others) {
  if (has_faint_ends(source) && !source.beside && !(source.free & trail_sagitta)) {
    // It was found along a bend, which was not fitted: noise may have made it.
    auto straight = straightened(scene, source);
    if (straight && gain_over(scene, *straight, source) > -min_gain) {
      straight->at_edge |= source.at_edge;
      source = std::move(*straight);
    }
  }
  for (int refit = 0; refit < max_refits && has_faint_ends(source) && !source.beside; ++refit) {
    auto other = refitted(scene, source, others);
    if (!other) break;
    other->at_edge |= source.at_edge;
    source = std::move(*other);
  }
  return source;
}

std::optional<EndErrors> errors_of_faint_ends(const Scene& scene, const Source& source) {
  if (!has_faint_ends(source)) return std::nullopt;
  EndErrors errors{};
  double most = -HUGE_VAL, all = 0.0;  // sums are in units of exp(most)
  for_pairs_of_ends(
      scene, source, [&](const Trail& line, const LineBetween& between, double pairs_px2) {
        if (!between.may_exceed(most - negligible)) return;
        const double odds = between.log_odds();
        if (!(odds > most - negligible)) return;
        if (odds > most) {
          const double fewer = std::exp(most - odds);
          for (auto& row : errors)
            for (double& value : row) value *= fewer;
          all *= fewer;
          most = odds;
        }
        const double likely = std::exp(odds - most) * pairs_px2;
        all += likely;
        between.add_to(errors, source.trail(), line.angle_rad - source.trail().angle_rad, likely);
      });
  if (!(all > 0)) return std::nullopt;
  for (auto& row : errors)
    for (double& value : row) value /= all;
  return errors;
}

}  // namespace dmise
