#include "core/detection/streaks/long_streak.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <optional>

#include "core/base/numeric/quantile.h"
#include "core/base/numeric/simd_level.h"
#include "core/detection/curve/streak_light.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/detection/source/line_profile.h"
#include "core/detection/source/source_fit.h"
#include "core/detection/source/star_hypothesis.h"
#include "core/detection/streaks/broad_streak.h"
#include "core/detection/streaks/evenness.h"
#include "core/detection/streaks/point_kernels.h"
#include "core/detection/streaks/streaks_beside.h"

namespace dmise {
namespace {

constexpr int max_lines = 12;              // in one component
constexpr int max_failures = 3;            // failed lines in a row, before it is given up
constexpr double worth_another_px = 50.0;  // a shorter component is given up after one failed line
constexpr int window_px = 16;              // step of growth
constexpr double growth_snr = 4.0;         // to continue into the next window
constexpr double gap_snr = 6.0;            // to continue beyond a gap
constexpr double min_rise = 2.0;           // over the scatter of lines beside it, before a fit
constexpr int max_rounds = 6;              // rounds of fitting and growing

double apart_px(const Point& a, const Point& b) {
  const double dx = b.x - a.x, dy = b.y - a.y;
  return std::sqrt(dx * dx + dy * dy);
}

Line line_through(const Point& a, const Point& b) {
  const double length = apart_px(a, b);
  return {a.x, a.y, (b.x - a.x) / length, (b.y - a.y) / length};
}

/// Points by coordinates, of which weights are summed along lines.
struct PointLanes {
  std::vector<double> x, y, weight;
  std::vector<double> after;  // weights from a block on

  explicit PointLanes(const std::vector<Point>& points) {
    const std::size_t step = points.size() / 400 + 1;
    for (std::size_t i = 0; i < points.size(); i += step) {
      x.push_back(points[i].x);
      y.push_back(points[i].y);
      weight.push_back(points[i].weight);
    }
    const std::size_t blocks = (x.size() + point_block - 1) / point_block;
    x.resize(blocks * point_block), y.resize(x.size()), weight.resize(x.size());
    after.assign(blocks + 1, 0.0);
    for (std::size_t b = blocks; b-- > 0;) {
      after[b] = after[b + 1];
      for (std::size_t i = b * point_block; i < (b + 1) * point_block; ++i) after[b] += weight[i];
    }
  }

  /// Weight of the points within `width_px` of a line; may be less where it is not above `most`.
  double within(const Line& line, double width_px, double most) const {
    static const auto weight_within = kernel_of(best_simd_level(), sse2::weight_within,
                                                avx2::weight_within, avx512::weight_within);
    const WeighedPoints points{x.data(), y.data(), weight.data(), after.data(), after.size() - 1};
    return weight_within(points, {line.x, line.y, line.ux, line.uy}, width_px, most);
  }
};

/// The line with the most points, from pairs of distant points; empty below `min_px`.
std::optional<Line> main_line(const std::vector<Point>& points, double width_px, double min_px) {
  const std::size_t anchors = std::min<std::size_t>(40, points.size());
  const PointLanes lanes(points);
  std::optional<Line> best;
  double most = 0.0;
  for (std::size_t a = 0; a < anchors; ++a)
    for (std::size_t b = a + 1; b < anchors; ++b) {
      const Point& p = points[a * (points.size() - 1) / (anchors - 1)];
      const Point& q = points[b * (points.size() - 1) / (anchors - 1)];
      if (apart_px(p, q) < min_px) continue;
      const Line line = line_through(p, q);
      const double weight = lanes.within(line, width_px, most);
      if (weight > most) {
        most = weight;
        best = line;
      }
    }
  return best;
}

/// Whether a line may grow across a window that is dark, as by noise alone, and whether it did.
struct Gaps {
  bool may_be_crossed = true, were_crossed = false;
};

/// Extends the line beyond one end while light of about the same level continues, one window at a
/// time.
void grow(const Scene& scene, const Line& line, Extent& extent, int way, double level, Gaps& gaps) {
  const int limit = line.by_columns() ? scene.counts.columns : scene.counts.rows;
  int gap = 0;
  while (true) {
    const int first = way > 0 ? extent.to + 1 + gap : extent.from - window_px - gap;
    const int last = first + window_px - 1;
    if (last < 0 || first >= limit) return;
    double best_snr = 0.0, best_mean = 0.0, best_offset_px = 0.0;
    for (const double offset : {0.0, -0.7, 0.7}) {
      const auto [mean, snr] = clipped_mean(slices(scene, line, first, last, offset), level);
      if (snr > best_snr) {
        best_snr = snr;
        best_mean = mean;
        best_offset_px = offset;
      }
    }
    if (best_snr > (gap ? gap_snr : growth_snr) && best_mean > 0.5 * level) {
      const Extent added = way > 0 ? Extent{extent.to - window_px / 2, last}
                                   : Extent{first, extent.from + window_px / 2};
      if (dark_gap(scene, line, added, level, best_offset_px)) return;
      if (way > 0)
        extent.to = std::min(last, limit - 1);
      else
        extent.from = std::max(first, 0);
      gaps.were_crossed |= gap > 0;
      gap = 0;
    } else if (gap == 0 && gaps.may_be_crossed) {
      gap = window_px;
    } else {
      return;
    }
  }
}

/// Returns the ends of the light: the cuts that best separate slices near `level` from slices near
/// zero.
Extent trimmed(const Scene& scene, const Line& line, const Extent& extent, double level) {
  const auto end = [&](int inside, int outside) {
    const int way = outside > inside ? 1 : -1;
    double sum = 0.0, most = 0.0;
    int best = inside;
    for (int k = inside; k != outside + way; k += way) {
      const Slice s = slice_at(scene, line, k, 0.0);
      // A star on the line carries no information.
      if (!(s.variance > 0) || s.e_per_px > 2 * level + 4 * std::sqrt(s.variance)) continue;
      sum += std::clamp(s.e_per_px, -level, 2 * level) - level / 2;
      if (sum > most) {
        most = sum;
        best = k;
      }
    }
    return best;
  };
  const int middle = (extent.from + extent.to) / 2;
  const int size = line.by_columns() ? scene.counts.columns : scene.counts.rows;
  Extent lit{std::max(extent.from, 0) - window_px, std::min(extent.to, size) + window_px};
  if (const auto gap = dark_gap(scene, line, {lit.from, middle}, level)) lit.from = gap->to + 1;
  if (const auto gap = dark_gap(scene, line, {middle, lit.to}, level)) lit.to = gap->from - 1;
  return {end(middle, lit.from), end(middle, lit.to)};
}

/// Whether a line is faint and hardly brighter than parallel lines, so that a fit is not worth it.
bool is_among_others(const Scene& scene, const Line& line, const Extent& extent, double level) {
  const Slice middle = slice_at(scene, line, (extent.from + extent.to) / 2, 0.0);
  if (middle.variance > 0 && level > detection_limits::even_snr_per_px * std::sqrt(middle.variance))
    return false;
  return rise_above_neighbours(scene, trail_along(line, extent, level)) < min_rise;
}

bool may_be_row(const Scene& scene, const Trail& streak) {
  return may_be_row_of_stars(scene, streak, detection_limits::chain_px);
}

/// Whether the light across a trail is that of the PSF, as of no hot column or edge, however it
/// changes along.
bool has_profile_of_psf(const Scene& scene, const Trail& trail) {
  constexpr double max_misfit = 0.3;
  const int reach = int(std::ceil(2.5 * scene.sigma_px)) + 1;
  const auto pixels = pixels_near(scene, trail, reach);
  const auto model = light_in(pixels, {&trail, 1}, scene.psf.at({trail.x_px, trail.y_px}));
  const Line line = line_of(trail);
  const auto lanes = std::size_t(2 * reach + 1);
  std::vector<double> seen(lanes, 0.0), told(lanes, 0.0);
  for (std::size_t i = 0; i < pixels.size(); ++i) {
    const Point at{double(pixels[i].x), double(pixels[i].y)};
    const double along = (at.x - line.x) * line.ux + (at.y - line.y) * line.uy;
    if (std::abs(along) > trail.length_px / 2) continue;
    const double r = along / line.half_length_px;
    const double off = line.off(at) - line.sagitta_px * (1.0 / 3 - r * r);
    const auto lane = std::lround(off) + reach;
    if (lane < 0 || lane >= long(lanes)) continue;
    seen[std::size_t(lane)] += double(pixels[i].signal_e);
    told[std::size_t(lane)] += model[i];
  }
  double both = 0.0, square = 0.0, off = 0.0, all = 0.0;
  for (std::size_t k = 0; k < lanes; ++k) both += seen[k] * told[k], square += told[k] * told[k];
  for (std::size_t k = 0; k < lanes; ++k) {
    off += std::abs(seen[k] - both / square * told[k]);
    all += std::abs(both / square * told[k]);
  }
  return off < max_misfit * all;
}

/// The final fit of a streak. The light of one that flickers or was put together of many exposures
/// differs from the model in proportion, so that the brightest fits worst: then the error of the
/// model is as large.
std::optional<Source> final_fit(const Scene& scene, const Trail& trail, double model_error) {
  constexpr double uneven_error = 0.3;
  const auto fits = [&](const std::optional<Source>& source) {
    return source && source->fit.reduced_chi2() <= (may_be_row(scene, source->trail()) ? 2.0 : 5.0);
  };
  auto source = fit_source(scene, trail, true, model_error);
  if (!fits(source) && model_error < uneven_error && !may_be_row(scene, trail) &&
      has_profile_of_psf(scene, trail))
    source = fit_source(scene, trail, true, uneven_error);
  if (!fits(source) || source->snr() < detection_limits::min_snr) return std::nullopt;
  return source;
}

constexpr double flicker_error = 1.0;  // relative error of the model for light that changes

/// The final fit of a streak whose light changes along it, with the light of a line of free pieces;
/// empty if that does not explain the pixels.
std::optional<Source> flickering_fit(const Scene& scene, const Trail& trail) {
  constexpr double max_misfit = 2.5;
  if (may_be_row(scene, trail) || !has_profile_of_psf(scene, trail)) return std::nullopt;
  auto source = fit_source(scene, trail, true, flicker_error);
  if (!source) return std::nullopt;
  *source = aligned(scene, std::move(*source));
  const auto light = streak_light(scene, *source);
  if (!light || light->misfit() > max_misfit) return std::nullopt;
  set_light(*light, *source);
  if (source->snr() < detection_limits::min_snr) return std::nullopt;
  return source;
}

/// The final fit of a streak with light all along it.
std::optional<Source> even_or_flickering(const Scene& scene, const Trail& trail,
                                         double model_error) {
  if (is_continuous(scene, trail)) {
    auto even = final_fit(scene, trail, model_error);
    if (even && is_continuous(scene, even->trail())) return even;
  }
  if (!is_lit_throughout(scene, trail)) return std::nullopt;
  auto source = flickering_fit(scene, trail);
  if (source && !is_lit_throughout(scene, source->trail())) source.reset();
  return source;
}

/// Alternates fitting and growing until the ends are stable.
std::optional<Source> streak_on(const Scene& scene, Line line, Extent extent, Gaps& gaps,
                                double model_error = 0.02) {
  std::optional<Source> source;
  for (int round = 0; round < max_rounds; ++round) {
    const double level = median_level(slices(scene, line, extent.from, extent.to, 0.0));
    if (!(level > 0)) return std::nullopt;
    const Trail rough = trail_along(line, extent, level);
    if (is_hopeless(scene, rough) && !is_lit_throughout(scene, rough)) return std::nullopt;
    if (round == 0 && is_among_others(scene, line, extent, level)) return std::nullopt;
    const Extent before = extent;
    grow(scene, line, extent, +1, level, gaps);
    grow(scene, line, extent, -1, level, gaps);
    extent = trimmed(scene, line, extent, level);
    if (source && std::abs(extent.from - before.from) <= 2 && std::abs(extent.to - before.to) <= 2)
      break;
    const Trail start = trail_along(line, extent, level);
    if (start.length_px < 6 * scene.sigma_px) return std::nullopt;
    const bool flickers = !is_continuous(scene, start) && is_lit_throughout(scene, start);
    source = fit_source(scene, start, true, flickers ? flicker_error : model_error, true);
    if (!source || source->trail().length_px < 6 * scene.sigma_px) return std::nullopt;
    const bool columns = line.by_columns();
    line = line_of(source->trail());
    if ((line.by_columns() ? line.ux : line.uy) < 0) {  // towards rising columns (rows)
      line.ux = -line.ux;
      line.uy = -line.uy;
      line.sagitta_px = -line.sagitta_px;
    }
    if (line.by_columns() != columns && round > 0) break;  // near 45 degrees: either works
    extent = extent_of(line, source->trail().length_px / 2);
  }
  source = even_or_flickering(scene, source->trail(), model_error);
  if (!source) return std::nullopt;
  const Trail& t = source->trail();
  if (may_be_row(scene, t) && (is_wide_body(scene, *source) || !beats_stars(scene, *source)))
    return std::nullopt;
  const Trail star = scene.star_trail(t.x_px, t.y_px);
  if (moves_like_star(scene, *source, star, detection_limits::min_difference_px + 1))
    return std::nullopt;
  return source;
}

/// The trail along the line with the light that is on it.
Trail trail_on(const Scene& scene, const Line& line, const Extent& extent) {
  return trail_along(line, extent, median_level(slices(scene, line, extent.from, extent.to, 0.0)));
}

/// Whether anything in the rectangle of a component may lie within a distance of a trail.
bool may_reach(const Trail& t, double margin_px, const Component& c) {
  const double cosine = std::abs(std::cos(t.angle_rad)), sine = std::abs(std::sin(t.angle_rad));
  const double along = t.length_px / 2 + margin_px + 1;
  const double across = std::abs(t.sagitta_px) + margin_px + 1;
  const double x = along * cosine + across * sine, y = along * sine + across * cosine;
  return t.x_px + x >= c.min_x && t.x_px - x <= c.max_x && t.y_px + y >= c.min_y &&
         t.y_px - y <= c.max_y;
}

/// What lies near any of several sources, within the rectangle of a component.
class AroundAny {
 public:
  AroundAny(const std::vector<Source>& sources, double margin_px, const Component& component) {
    for (const Source& source : sources) {
      const double px = std::max(margin_px, 3 * source.broad_sigma_px + 1.5);
      if (may_reach(source.trail(), px, component)) around_.emplace_back(source.trail(), px);
    }
  }
  bool has(double x_px, double y_px) const {
    return std::ranges::any_of(around_, [&](const Around& one) { return one.has(x_px, y_px); });
  }

 private:
  std::vector<Around> around_;
};

/// Points of the component off known streaks. Weights are the light, limited to the level of the
/// brightest fifth: a star on a streak must not outweigh the streak.
std::vector<Point> free_points(const Scene& scene, const Component& component, double skirt_px,
                               const std::vector<Source>& found) {
  const AroundAny streaks(found, skirt_px, component);
  std::vector<Point> points;
  std::vector<double> lights;
  for (const Run& run : component.runs)
    for (int x = run.first_x; x <= run.last_x; ++x) {
      if (streaks.has(x, run.y) || scene.is_hidden(x, run.y)) continue;
      points.push_back({double(x), double(run.y), std::max(1.0f, scene.pixel(x, run.y).signal_e)});
      lights.push_back(points.back().weight);
    }
  if (points.empty()) return points;
  const double cap = value_of_rank(lights, lights.size() * 4 / 5);
  for (Point& p : points) p.weight = std::min(p.weight, cap) / cap;
  return points;
}

/// The streak on a broad line, if there is one.
std::vector<Source> broad_streak(const Scene& scene, const BroadLine& broad) {
  Scene wide = scene;
  wide.use(PsfField::gaussian(fwhm_before_pixel(broad.sigma_px)));
  Gaps gaps;
  auto source = streak_on(wide, broad.line, broad.extent, gaps, broad_profile_error);
  if (!source) return {};
  source->broad_sigma_px = broad.sigma_px;
  return {std::move(*source)};
}

}  // namespace

void find_long_streaks(const Scene& scene, const Component& component, std::vector<Source>& found) {
  const double width_px = 1.5 * scene.sigma_px + 0.5, min_px = 8 * scene.sigma_px;
  // The distance at which a streak with the component's peak falls below the connecting threshold.
  const double rise = std::log(std::max(component.peak_snr / detection_limits::connect_snr, 1.0));
  const double skirt_px = std::max(3.0, 2 * std::sqrt(rise)) * scene.sigma_px + 1.5;
  std::vector<Point> points = free_points(scene, component, skirt_px, found);
  const double extent_px =
      std::hypot(component.max_x - component.min_x + 1, component.max_y - component.min_y + 1);
  int failures = 0;
  for (int n = 0; n < max_lines && points.size() >= 2 * std::size_t(min_px); ++n) {
    const auto rough = main_line(points, width_px, min_px);
    if (!rough) break;
    Line line = principal_axis(points, *rough, 2 * width_px);
    line = principal_axis(points, line, width_px);
    std::vector<double> on;
    for (const Point& p : points)
      if (std::abs(line.off(p)) < width_px) on.push_back(line.major(p));
    if (on.size() < 8) break;
    const auto [low, high] = std::minmax_element(on.begin(), on.end());
    if ((*high - *low) * line.slice_px() < min_px) break;
    const auto broad = broad_line(scene, points, *rough);
    std::vector<Source> sources;
    if (broad && broad->is_no_pair) sources = broad_streak(scene, *broad);
    if (sources.empty()) {
      Gaps gaps, none{.may_be_crossed = false};
      auto source = streak_on(scene, line, {int(*low), int(*high)}, gaps);
      // What is uneven with others behind it may be one of a row.
      if (!source && gaps.were_crossed)
        source = streak_on(scene, line, {int(*low), int(*high)}, none);
      sources = streaks_beside(
          scene, source ? source->trail() : trail_on(scene, line, {int(*low), int(*high)}));
      if (sources.empty() && source) sources.push_back(std::move(*source));
    }
    if (sources.empty() && broad && !broad->is_no_pair) sources = broad_streak(scene, *broad);
    const AroundAny streaks(sources, skirt_px, component);
    std::erase_if(points, [&](const Point& p) {
      return std::abs(line.off(p)) < width_px || streaks.has(p.x, p.y);
    });
    if (!sources.empty()) {
      std::move(sources.begin(), sources.end(), std::back_inserter(found));
      failures = 0;
    } else if (extent_px < worth_another_px || ++failures == max_failures) {
      break;
    }
  }
}

}  // namespace dmise
