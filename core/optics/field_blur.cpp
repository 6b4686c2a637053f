#include "core/optics/field_blur.h"

#include <algorithm>
#include <cmath>
#include <cstdlib>

#include "core/base/units.h"
#include "core/effects/plan_facts.h"
#include "core/optics/psf_table.h"
#include "core/optics/pupil_sampling.h"

namespace dmise {
namespace {

constexpr int max_noll = 66;

/// Distance of a place from the axis in the tables' unit; beyond what the lens images their end.
double radius_at(const Optics& optics, double height) {
  return field_radius_at(optics, height * corner_px(optics), optics.spread.varying.radius)
      .value_or(1e9);
}

/// The other term of an order and frequency.
int partner(int noll) {
  const auto [n, m] = noll_orders(noll);
  return noll_orders(noll + 1) == std::array{n, -m} ? noll + 1 : noll - 1;
}

/// Phases of Noll's terms at a place [rad rms], by index.
using Phases = std::array<double, max_noll + 1>;
Phases phases_at(const Optics& optics, const FieldPlace& place, double wavelength_m) {
  Phases phases{};
  for (const WavefrontTerm& t : terms_of_field(optics, place))
    phases[std::size_t(t.noll)] += 2 * pi / wavelength_m * t.rms_m;
  return phases;
}

double size_of(const Phases& a, const Phases& b) {
  double sum = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(sum);
}

/// Relative size of a difference of shapes, sqrt(tr (C^-1 D C^-1 D)).
double size_of(const GaussianShape& c, const GaussianShape& d) {
  const double det = c.xx * c.yy - c.xy * c.xy;
  const double xx = (c.yy * d.xx - c.xy * d.xy) / det, xy = (c.yy * d.xy - c.xy * d.yy) / det;
  const double yx = (c.xx * d.xy - c.xy * d.xx) / det, yy = (c.xx * d.yy - c.xy * d.xy) / det;
  return std::sqrt(std::max(0.0, xx * xx + 2 * xy * yx + yy * yy));
}

/// A kernel of the grid, with its weight at a place.
struct Node {
  FieldPlace place;
  double weight = 0.0;
};

FieldPlace place_of(const Optics& o, double across, double down) {
  const double x_px = (across - 0.5) * o.columns, y_px = (down - 0.5) * o.rows;
  return {std::hypot(x_px, y_px) / corner_px(o), std::atan2(y_px, x_px)};
}

/// The four kernels around a place, given as fractions of the frame.
std::array<Node, 4> nodes_around(const Optics& o, double across, double down, int n) {
  if (n == 1) return {Node{{}, 1.0}};
  const auto cell = [&](double at) { return std::min(int(at * (n - 1)), n - 2); };
  const int i = cell(across), j = cell(down);
  const double u = across * (n - 1) - i, v = down * (n - 1) - j, side = n - 1.0;
  return {Node{place_of(o, i / side, j / side), (1 - u) * (1 - v)},
          Node{place_of(o, (i + 1) / side, j / side), u * (1 - v)},
          Node{place_of(o, i / side, (j + 1) / side), (1 - u) * v},
          Node{place_of(o, (i + 1) / side, (j + 1) / side), u * v}};
}

/// The share of light that a mean of pupils' kernels misplaces: half of the largest difference of
/// the light, which a difference of phase of rms d changes by 2 d; to second order the mean's phase
/// and the squares of the differences.
double misplaced_by_pupils(const Optics& o, const FieldPlace& place, double wavelength_m,
                           const std::array<Node, 4>& nodes) {
  const Phases here = phases_at(o, place, wavelength_m);
  Phases mean{};
  double first = 0.0, second = 0.0;
  for (const Node& node : nodes) {
    if (node.weight == 0.0) continue;
    const Phases there = phases_at(o, node.place, wavelength_m);
    const double d = size_of(there, here);
    first += node.weight * d;
    second += node.weight * d * d;
    for (std::size_t i = 0; i < mean.size(); ++i) mean[i] += node.weight * there[i];
  }
  constexpr double of_squares = 1.4;  // half, and half of the squares' own rms, 1.8 of their mean
  return std::min({1.0, first, size_of(mean, here) + of_squares * second});
}

/// Share of the light that Gaussians misplace: 0.3 of a relative change of the shape is elsewhere.
double misplaced_by_gaussians(const Optics& o, const FieldPlace& place, double wavelength_m,
                              const std::array<Node, 4>& nodes) {
  const GaussianShape here = gaussian_at(o, place, wavelength_m);
  GaussianShape mean{-here.xx, -here.xy, -here.yy};
  double first = 0.0, second = 0.0;
  for (const Node& node : nodes) {
    if (node.weight == 0.0) continue;
    const GaussianShape there = gaussian_at(o, node.place, wavelength_m);
    const double d = size_of(here, {there.xx - here.xx, there.xy - here.xy, there.yy - here.yy});
    first += node.weight * d;
    second += node.weight * d * d;
    mean.xx += node.weight * there.xx;
    mean.xy += node.weight * there.xy;
    mean.yy += node.weight * there.yy;
  }
  return std::min({1.0, 0.5 * first, 0.3 * size_of(here, mean) + 0.5 * second});
}

}  // namespace

ErrorBound FieldBlur::error(int level, const PlanFacts& f) {
  return f.misplaced(f.field_misplaced[std::size_t(level)], f.field_shift_px[std::size_t(level)]);
}

double FieldBlur::cost_s(int level, const PlanFacts& f) {
  const int n = places[std::size_t(level)];
  const double transforms_s = 0.5 * (n * n - 1) * PlanFacts::transform_pixel_s * f.pixels();
  return transforms_s + 0.01 * n * n * f.kernel_s;
}

std::vector<WavefrontTerm> terms_of_field(const Optics& optics, const FieldPlace& place) {
  std::vector<WavefrontTerm> terms;
  const FieldBlur& field = optics.spread.varying;
  if (field.wavefront.empty()) return terms;
  const double radius = radius_at(optics, place.radius);
  for (const FieldTerm& t : field.wavefront) {
    const double rms_m = t.rms_m(radius);
    const int m = noll_orders(t.noll)[1];
    if (m == 0) {
      terms.push_back({t.noll, rms_m});
      continue;
    }
    if (place.radius == 0.0) continue;
    // cos m(theta - a) and sin m(theta - a) as sums of both terms.
    const double a = std::abs(m) * place.angle_rad;
    terms.push_back({t.noll, rms_m * std::cos(a)});
    terms.push_back({partner(t.noll), (m > 0 ? 1.0 : -1.0) * rms_m * std::sin(a)});
  }
  return terms;
}

GaussianShape gaussian_at(const Optics& optics, const FieldPlace& place, double wavelength_m) {
  const double sigma_px = psf_sigma_px(optics, wavelength_m), everywhere = sigma_px * sigma_px;
  const FieldBlur& field = optics.spread.varying;
  if (field.fwhm_radial_px.empty()) return {everywhere, 0.0, everywhere};
  const double radius = radius_at(optics, place.radius);
  const double along = field.fwhm_radial_px(radius) / fwhm_per_sigma,
               across = field.fwhm_tangential_px(radius) / fwhm_per_sigma;
  const double mean = 0.5 * (along * along + across * across),
               half = place.radius == 0.0 ? 0.0 : 0.5 * (along * along - across * across);
  const double c = std::cos(2 * place.angle_rad), s = std::sin(2 * place.angle_rad);
  return {everywhere + mean + half * c, half * s, everywhere + mean - half * c};
}

std::vector<double> table_heights(const Optics& optics) {
  constexpr int even = 8;
  std::vector<double> heights;
  for (int i = 0; i <= even; ++i) heights.push_back(double(i) / even);
  const FieldBlur& field = optics.spread.varying;
  const auto add = [&](const MonotoneCubic& table) {
    for (const double radius : table.at()) {
      const double height = height_px(optics, radius, field.radius) / corner_px(optics);
      if (height > 0.0 && height < 1.0) heights.push_back(height);
    }
  };
  add(field.fwhm_radial_px);
  for (const FieldTerm& t : field.wavefront) add(t.rms_m);
  std::sort(heights.begin(), heights.end());
  heights.erase(std::unique(heights.begin(), heights.end()), heights.end());
  return heights;
}

WidthRange gaussian_widths(const Optics& optics, double wavelength_m) {
  WidthRange range{1e9, 0.0};
  for (const double height : table_heights(optics)) {
    const GaussianShape shape = gaussian_at(optics, {height, 0.0}, wavelength_m);
    range.min_px = std::min({range.min_px, std::sqrt(shape.xx), std::sqrt(shape.yy)});
    range.max_px = std::max({range.max_px, std::sqrt(shape.xx), std::sqrt(shape.yy)});
  }
  return range;
}

double field_spot_px(const Optics& optics) {
  double steepest_m = 0.0;
  if (optics.spread.varying.wavefront.empty()) return 0.0;
  for (const double height : table_heights(optics)) {
    std::vector<ZernikeTerm> terms;  // with path in place of phase
    for (const WavefrontTerm& t : terms_of_field(optics, {height, 0.0}))
      terms.push_back({t.noll, t.rms_m});
    steepest_m = std::max(steepest_m, steepest_slope_of(terms));
  }
  return steepest_m * 2 * optics.f_number() / optics.pixel_pitch_m;
}

std::array<double, 2> centroid_of_field_px(const Optics& optics, const FieldPlace& place) {
  Pupil pupil{.aperture_m = optics.aperture_m, .obscuration = optics.obscuration};
  for (const WavefrontTerm& t : terms_of_field(optics, place))
    pupil.wavefront.push_back({t.noll, t.rms_m});
  const auto tilt = centring_tilt(pupil);
  // Noll's tilt of a rms has the slope 2 a over the radius of the aperture.
  const double px_per_m = 4 * optics.f_number() / optics.pixel_pitch_m;
  return {-tilt[0].rms_rad * px_per_m, -tilt[1].rms_rad * px_per_m};
}

FieldGridError field_grid_error(const Optics& optics, double wavelength_m, int n) {
  FieldGridError error;
  if (!optics.spread.varying.any()) return error;
  constexpr int samples = 24;  // over half a side: lenses are symmetric, and grids
  constexpr double margin = 1.1;
  const bool pupils = !optics.spread.varying.wavefront.empty();
  for (int j = 0; j <= samples; ++j)
    for (int i = 0; i <= samples; ++i) {
      const double across = 0.5 * i / samples, down = 0.5 * j / samples;
      const FieldPlace place = place_of(optics, across, down);
      const auto nodes = nodes_around(optics, across, down, n);
      const double misplaced = pupils ? misplaced_by_pupils(optics, place, wavelength_m, nodes)
                                      : misplaced_by_gaussians(optics, place, wavelength_m, nodes);
      error.misplaced = std::max(error.misplaced, std::min(1.0, margin * misplaced));
      if (!pupils) continue;
      auto shift = centroid_of_field_px(optics, place);
      for (const Node& node : nodes) {
        if (node.weight == 0.0) continue;
        const auto there = centroid_of_field_px(optics, node.place);
        for (std::size_t k = 0; k < 2; ++k) shift[k] -= node.weight * there[k];
      }
      error.shift_px = std::max(error.shift_px, margin * std::hypot(shift[0], shift[1]));
    }
  return error;
}

}  // namespace dmise
