#include "core/detection/streaks/faint_streaks.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/units.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/detection/source/hidden_ends.h"
#include "core/detection/source/line_profile.h"
#include "core/detection/source/line_search.h"
#include "core/detection/source/source_fit.h"
#include "core/detection/source/star_hypothesis.h"
#include "core/detection/source/template_snr.h"

namespace dmise {
namespace {

constexpr double min_share = 0.4;      // pixels of a trail that are not hidden, over all
constexpr double chain_px = 40.0;      // longest row of stars, without their trails
constexpr double candidate_snr = 4.7;  // a beamlet may be a part of a streak
// Gain in SNR^2 that a longer line needs: in any direction, and along a streak.
constexpr double min_gain = 10.0, min_gain_of_streak = 1.0;
constexpr double short_in_sigmas = 12.0;
constexpr int max_failures = 30;        // failed fits by which a frame counts as full of structures
constexpr double template_px = 130.0;   // longest streak whose ends count
constexpr double sum_misses_snr = 1.6;  // SNR that the sum misses of such a streak, at most
constexpr double sum_misses_px = 32.0;  // length up to which the sum may miss so much
// Share of candidate_snr: less is left where a streak that was found since has hidden it.
constexpr double left_share = 0.8;
constexpr double star_ratio = 1.2;  // so much more SNR on a star's trail explains a short candidate
// Share of the SNR along the line: a fit with less went elsewhere.
constexpr double fitted_share = 0.7;
// Share of the least SNR: the fit also fits the sky, which costs some; for a faint patch more.
constexpr double sky_share = 0.85;
constexpr double max_chi2 = 2.0;     // reduced: with more it is no line of light
constexpr double piece_share = 0.9;  // a piece is shorter, relative to the streak
constexpr double arc_px = 100.0;     // from which length on a bend shows at any SNR
constexpr double bright_arc_px = 15.0, bright_arc_snr = 12.0;  // and with this SNR, as brightness
constexpr double min_climb_snr = 3.0;  // from which on a climb moves ends and bend, too
// Scatter over noise, and share of hidden pixels, that any cell has by chance.
constexpr double usual_scatter = 0.05, usual_hidden = 0.1;
// Limits of a component: greatest peak of a faint streak's part, and by how much SNR^2 along a line
// through it must exceed that of a star there. More of them are the stars of a crowded field.
constexpr double max_part_peak_snr = 9.0, min_gain_over_star = 36.0;
constexpr std::size_t max_parts = 400;
// Least SNR of 16 px, and by how much it rises with each doubling, to 64 px: longer lines are tried
// at more places.
constexpr double short_streak_snr = 6.5, snr_per_doubling = 0.5, shortest_px = 16.0;

Trail trail_of(const Beamlet& b) {
  return {.x_px = 0.5 * (b.x1 + b.x2),
          .y_px = 0.5 * (b.y1 + b.y2),
          .length_px = std::hypot(b.x2 - b.x1, b.y2 - b.y1),
          .angle_rad = std::atan2(b.y2 - b.y1, b.x2 - b.x1)};
}

/// Whether most of a trail lies on another.
bool is_part_of(const Trail& part, const Trail& whole, double margin_px) {
  const double reach_px =
      0.5 * (part.length_px + whole.length_px) + std::abs(whole.sagitta_px) + margin_px;
  if (std::abs(part.x_px - whole.x_px) > reach_px || std::abs(part.y_px - whole.y_px) > reach_px)
    return false;
  const double c = std::cos(part.angle_rad), s = std::sin(part.angle_rad);
  const Around around(whole, margin_px);
  int on = 0;
  for (int k = -2; k <= 2; ++k) {
    const double along = 0.25 * k * part.length_px;
    on += around.has(part.x_px + along * c, part.y_px + along * s);
  }
  return on >= 3;
}

void hide(FilteredFrame& frame, TurnedFrame& turned, const Trail& t, double margin_px) {
  const Around around(t, margin_px);
  around.for_rows(frame.columns, frame.rows, [&](int y, int begin, int end) {
    for (int x = begin; x < end; ++x)
      if (around.has(x, y)) frame.hide(y, x, x), turned.hide(x, y);
  });
}

/// The fit of a streak of `snr`. What it is too faint to show is not fitted.
std::optional<Source> fitted(const Scene& scene, const Trail& trail, double snr) {
  unsigned free = trail_line;
  if (trail.length_px > arc_px) free |= trail_sagitta;
  if (snr > bright_arc_snr && trail.length_px > bright_arc_px) free |= trail_slope | trail_sagitta;
  for (const unsigned mask : {free, unsigned(trail_line), unsigned(trail_place)}) {
    auto source = fit_source(scene, trail, true, 0.0, false, mask);
    if (source && source->snr() > fitted_share * snr) return source;
  }
  return std::nullopt;
}

/// SNR of the best star's trail with its middle on a trail.
double star_snr_on(const FilteredFrame& frame, const Trail& trail, Trail star) {
  const double c = std::cos(trail.angle_rad), s = std::sin(trail.angle_rad);
  double most = 0.0;
  const int steps = int(std::ceil(trail.length_px)) + 2;
  for (int k = -steps / 2; k <= steps / 2; ++k)
    for (int across = -1; across <= 1; ++across) {
      star.x_px = std::round(trail.x_px + k * c - across * s);
      star.y_px = std::round(trail.y_px + k * s + across * c);
      most = std::max(most, snr_along(frame, star));
    }
  return most;
}

bool is_streak(const Scene& scene, const Source& source) {
  const Trail& t = source.trail();
  if (source.snr() < sky_share * min_streak_snr(t.length_px)) return false;
  if (t.length_px < 3 * scene.sigma_px || source.fit.reduced_chi2() > max_chi2) return false;
  const Trail star = scene.star_trail(t.x_px, t.y_px);
  if (may_be_row_of_stars(scene, t, chain_px) &&
      (is_wide_body(scene, source) || !beats_stars(scene, source)))
    return false;
  return !moves_like_star(scene, source, star, detection_limits::min_difference_px + 1);
}

/// The slices of a trail's line between which a light of `e_per_px` is not there.
std::optional<Extent> gap_in(const Scene& scene, const Trail& t, double e_per_px) {
  const Line line = line_of(t);
  return dark_gap(scene, line, extent_of(line, t.length_px / 2), e_per_px);
}

/// By how much more a line must rise above those beside it where stars trail in its direction: it
/// then collects whole trails of faint stars, which are few and bright beside noise.
double rise_among_trails(const Scene& scene, const Trail& line) {
  constexpr double most_more = 0.8;
  return 1.0 + most_more * share_of_trails_on(scene, line);
}

/// A streak, or each of several behind each other that were found as one.
std::vector<Source> pieces(const Scene& scene, Source source) {
  const Trail& t = source.trail();
  const double e_per_px = t.flux_e / std::max(t.length_px, 1.0);
  std::vector<Source> out;
  if (const auto gap = gap_in(scene, t, e_per_px)) {
    const Line line = line_of(t);
    const Extent all = extent_of(line, t.length_px / 2);
    for (const Extent& side : {Extent{all.from, gap->from - 1}, Extent{gap->to + 1, all.to}}) {
      if (side.to - side.from < 2) continue;
      auto piece = fitted(scene, trail_along(line, side, e_per_px), 0.0);
      if (!piece || piece->trail().length_px > piece_share * t.length_px ||
          !is_streak(scene, *piece))
        continue;
      for (Source& part : pieces(scene, std::move(*piece))) out.push_back(std::move(part));
    }
  }
  if (out.empty()) out.push_back(std::move(source));
  return out;
}

/// The streak with the light that was hidden with components beside its ends: pieces of it, which
/// had the shape of stars. Where it does not fit, the ends may be anywhere there.
Source with_hidden_light(const Scene& scene, const Scene& seen, Source source) {
  if (scene.known) return source;  // what is hidden is stars
  const Trail& t = source.trail();
  const HiddenEnds gaps = hidden_ends(seen, t);
  if (!(gaps.first_px + gaps.last_px > 0)) return source;
  Trail longer = t;
  const double middle_px = 0.5 * (gaps.last_px - gaps.first_px);
  longer.x_px += middle_px * std::cos(t.angle_rad);
  longer.y_px += middle_px * std::sin(t.angle_rad);
  longer.length_px += gaps.first_px + gaps.last_px;
  longer.flux_e *= longer.length_px / t.length_px;
  auto whole = fitted(scene, longer, source.snr());
  if (whole && whole->snr() > source.snr() && whole->fit.reduced_chi2() < max_chi2 &&
      whole->trail().length_px < longer.length_px + 4 * scene.sigma_px)
    return std::move(*whole);
  add_errors_of_hidden_ends(seen, source);
  return source;
}

/// The best of the lines climbed from short ones of any direction through a place.
Trail best_line_through(const FilteredFrame& frame, const Trail& place, double sigma_px) {
  constexpr int directions = 12;
  Trail line = place, best = place;
  line.length_px = 6 * sigma_px;
  line.sagitta_px = line.slope = 0.0;
  double most = 0.0;
  for (int k = 0; k < directions; ++k) {
    line.angle_rad = pi * k / directions;
    const Trail trial = climbed(frame, line, min_climb_snr);
    const double snr = snr_along(frame, trial);
    if (!(snr > most)) continue;
    most = snr;
    best = trial;
  }
  return best;
}

/// The fit of a longer line, if it has more of a source's light.
std::optional<Source> fitted_longer(const Scene& scene, const FilteredFrame& frame,
                                    const Source& source, Trail start, bool turned,
                                    double known_snr) {
  const Trail& known = source.trail();
  const double min_px = (source.streak ? 0.5 : 2.0) * scene.sigma_px;
  if (start.length_px < known.length_px + min_px) return std::nullopt;
  if (source.streak && !turned &&
      gap_in(scene, start, known.flux_e / std::max(known.length_px, 1.0)))
    return std::nullopt;
  const double snr = snr_along(frame, start);
  const double gain = turned ? std::pow(template_snr(scene, start), 2) - known_snr * known_snr
                             : snr * snr - std::pow(snr_along(frame, known), 2);
  if (gain < (turned ? min_gain : min_gain_of_streak)) return std::nullopt;
  start.flux_e = known.flux_e * start.length_px / std::max(known.length_px, 2 * scene.sigma_px);
  auto fit = fitted(scene, start, snr);
  if (fit && (fit->trail().length_px <= known.length_px || fit->snr() <= source.snr())) fit.reset();
  return fit;
}

/// A source with more of its light along its line, if there is.
std::optional<Source> longer(const Scene& scene, const FilteredFrame& frame, const Source& source) {
  const Trail& known = source.trail();
  if (source.saturated || (!source.streak && !scene.known) ||
      source.snr() > detection_limits::faint_per_px * std::sqrt(std::max(known.length_px, 4.0)))
    return std::nullopt;
  const double known_snr = template_snr(scene, known);
  // The direction of a short one may be that of noise.
  const bool is_short = known.length_px < short_in_sigmas * scene.sigma_px;
  std::optional<Source> fit;
  if (source.streak)
    fit =
        fitted_longer(scene, frame, source, climbed(frame, known, min_climb_snr), false, known_snr);
  if (!fit && is_short)
    fit = fitted_longer(scene, frame, source, best_line_through(frame, known, scene.sigma_px), true,
                        known_snr);
  return fit;
}

/// The best of straight lines of a few lengths and directions through a place.
Trail rough_line_through(const FilteredFrame& frame, const Trail& place, double sigma_px) {
  constexpr int directions = 24, offsets = 1;
  constexpr double shortest_sigmas = 8.0,
                   longest_sigmas = 130.0;  // lengths double from one to the other
  constexpr double offset_share = 0.4;      // shift over the length: the place may be near an end
  Trail line = place, best = place;
  double most = 0.0;
  for (double length_px = shortest_sigmas * sigma_px; length_px < longest_sigmas * sigma_px;
       length_px *= 2)
    for (int k = 0; k < directions; ++k)
      for (int offset = -offsets; offset <= offsets; ++offset) {
        line.length_px = length_px;
        line.angle_rad = pi * k / directions;
        line.x_px = place.x_px + offset_share * offset * length_px * std::cos(line.angle_rad);
        line.y_px = place.y_px + offset_share * offset * length_px * std::sin(line.angle_rad);
        const double snr = snr_along(frame, line);
        if (!(snr > most)) continue;
        most = snr;
        best = line;
      }
  return best;
}

/// The faint streak through a component, if there is one.
std::optional<Source> streak_through(const Scene& seen, const FilteredFrame& frame,
                                     const TurnedFrame& turned, const Component& part,
                                     LineBand& band) {
  const Trail star = seen.star_trail(part.peak_x, part.peak_y);
  const Trail rough = rough_line_through(frame, star, seen.sigma_px);
  const auto gains = [&](double snr, const Trail& line) {
    return snr * snr - std::pow(star_snr_on(frame, line, star), 2);
  };
  if (snr_along(frame, rough) < candidate_snr) return std::nullopt;
  Trail line = climbed(frame, rough);
  const LineSum sum = sum_along(frame, line);
  const double snr = sum.sum / sum.noise;
  if (sum.samples < min_share * sum.slices || snr < min_streak_snr(line.length_px) ||
      gains(snr, line) < min_gain_over_star)
    return std::nullopt;
  const ParallelLines near = parallel_lines(frame, turned, line, band);
  if (snr < near.median + min_streak_snr(line.length_px) * near.scatter * crowding(frame, line) *
                              rise_among_trails(seen, line))
    return std::nullopt;
  const float noise_e = std::sqrt(seen.pixel_around(line.x_px, line.y_px).variance_e2);
  line.flux_e = sum.sum / sum.samples / FilteredFrame::steps * noise_e * line.length_px;
  auto source = fitted(seen, line, snr);
  if (source && !is_streak(seen, *source)) source.reset();
  return source;
}

}  // namespace

double crowding(const FilteredFrame& frame, const Trail& trail) {
  const FilteredFrame::Cell cell = frame.cell_at(trail.x_px, trail.y_px);
  const double scatter = std::max(1.0, double(cell.scatter) - usual_scatter);
  return scatter * (1.0 + std::max(0.0, double(cell.hidden) - usual_hidden));
}

double min_streak_snr(double length_px) {
  return short_streak_snr +
         snr_per_doubling * std::clamp(std::log2(length_px / shortest_px), 0.0, 2.0);
}

void extend(const Scene& scene, const FilteredFrame& frame, Source& source) {
  constexpr int max_rounds = 4;
  for (int round = 0; round < max_rounds; ++round) {
    auto more = longer(scene, frame, source);
    if (!more) return;
    source = std::move(*more);
  }
}

bool may_be_part_of_streak(const Component& component) {
  return component.peak_snr < max_part_peak_snr;
}

std::vector<Source> streaks_through(const Scene& scene, FilteredFrame& frame,
                                    const std::vector<const Component*>& parts) {
  std::vector<Source> found;
  if (parts.size() > max_parts) return found;
  Scene seen = scene;
  seen.hidden = &frame;
  TurnedFrame turned(frame);
  LineBand band;
  const double margin_px = 2 * scene.sigma_px + 1;
  for (const Component* part : parts) {
    const bool is_known = std::ranges::any_of(found, [&](const Source& source) {
      return Around(source.trail(), margin_px).has(part->peak_x, part->peak_y);
    });
    if (is_known) continue;
    auto source = streak_through(seen, frame, turned, *part, band);
    if (!source) continue;
    hide(frame, turned, source->trail(), 4 * scene.sigma_px);
    for (Source& piece : pieces(scene, std::move(*source))) found.push_back(std::move(piece));
  }
  return found;
}

std::vector<Source> find_faint_streaks(const Scene& scene, FilteredFrame& frame, Threads& threads) {
  Scene seen = scene;
  seen.hidden = &frame;
  TurnedFrame turned(frame);
  const std::vector<Beamlet> beamlets =
      find_beamlets(frame, turned, candidate_snr, best_simd_level(), threads);
  LineBand band;
  const double margin_px = 2 * scene.sigma_px + 1;
  std::vector<Source> found;
  std::vector<Trail> tried;
  int failures = 0;
  for (const Beamlet& beamlet : beamlets) {
    Trail trail = trail_of(beamlet);
    if (beamlet.snr < candidate_snr) continue;  // `find_beamlets` rounds its threshold down
    if (snr_along(frame, trail) < left_share * candidate_snr) continue;
    if (std::any_of(tried.begin(), tried.end(),
                    [&](const Trail& t) { return is_part_of(trail, t, margin_px); }))
      continue;
    const Trail star = scene.star_trail(trail.x_px, trail.y_px);
    if (trail.length_px < chain_px && star_snr_on(frame, trail, star) > star_ratio * beamlet.snr)
      continue;
    // Where the light along parallel lines scatters more than noise, so must a streak.
    const ParallelLines around = parallel_lines(frame, turned, trail, band);
    if (beamlet.snr < around.median + candidate_snr * around.scatter) continue;
    trail = climbed(frame, trail);
    tried.push_back(trail);
    const LineSum line = sum_along(frame, trail);
    double snr = line.sum / line.noise;
    if (line.samples < min_share * line.slices) continue;
    if (snr < min_streak_snr(trail.length_px)) {
      // The sum of a short line misses light beside its ends.
      const double misses = sum_misses_snr * std::min(1.0, sum_misses_px / trail.length_px);
      if (trail.length_px > template_px || snr < min_streak_snr(trail.length_px) - misses) continue;
      const TemplateMatch match = best_template(seen, trail);
      if (match.snr < min_streak_snr(match.trail.length_px)) continue;
      trail = match.trail;
      snr = match.snr;
    }
    const double per_px = line.sum / line.samples / FilteredFrame::steps;
    const float noise_e = std::sqrt(scene.pixel_around(trail.x_px, trail.y_px).variance_e2);
    trail.flux_e = per_px * noise_e * trail.length_px;
    const ParallelLines near = parallel_lines(frame, turned, trail, band);
    if (snr < near.median + min_streak_snr(trail.length_px) * near.scatter *
                                crowding(frame, trail) * rise_among_trails(scene, trail))
      continue;
    const double star_snr = star_snr_on(frame, trail, star);
    if (snr * snr - star_snr * star_snr < detection_limits::blend_margin) continue;
    auto source = fitted(seen, trail, snr);
    if (source) hide(frame, turned, source->trail(), 4 * scene.sigma_px);
    if (source && is_streak(scene, *source))
      for (Source& piece : pieces(scene, std::move(*source)))
        found.push_back(with_hidden_light(scene, seen, std::move(piece)));
    else if (++failures == max_failures)
      break;
  }
  return found;
}

}  // namespace dmise
