#include "core/wcs/wcs_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/algebra/least_squares.h"
#include "core/base/error.h"
#include "core/base/units.h"
#include "core/optics/projection.h"
#include "core/wcs/wcs.h"
#include "core/wcs/wcs_refraction.h"

namespace dmise {
namespace {

constexpr int fit_points = 24, check_points = 37, table_points = 33;
// Allowances for errors between the sampled points.
constexpr double between_points = 1.3, between_cells = 1.25;
constexpr double good_px = 0.08;  // error of a WCS as a whole
constexpr double good_low_order_px = 0.01;
constexpr int highest_order = 9;  // limit of SIP by its convention
constexpr double good_table_px = 0.06;
constexpr double min_cell_px = 3.0;
// Nothing is fitted near the antipode of the axis, where a projection diverges.
constexpr double farthest_fitted_cos = -0.9;
constexpr double low_rad = 20 * deg;  // above it polynomials represent refraction
constexpr int max_nodes = 400;        // along a lookup table's longer side

struct Sample {
  PixelPosition pixel;
  Vec<Gcrs> direction;
};

/// The part of the frame that can image anything: half its sides.
std::array<double, 2> half_sides_px(const Optics& o) {
  const double rim_px = o.projection.rim() * o.focal_length_px();
  return {std::min(0.5 * o.columns, rim_px), std::min(0.5 * o.rows, rim_px)};
}

/// Samples `sky` on a grid of Chebyshev points.
std::vector<Sample> samples_of(const Optics& optics, const SkyOfPixel& sky, int points) {
  const PixelPosition centre = principal_point(optics);
  const auto half = half_sides_px(optics);
  std::vector<Sample> all;
  for (int j = 0; j < points; ++j)
    for (int i = 0; i < points; ++i) {
      const PixelPosition pixel{centre.x_px - half[0] * std::cos(pi * i / (points - 1)),
                                centre.y_px - half[1] * std::cos(pi * j / (points - 1))};
      if (const auto direction = sky(pixel)) all.push_back({pixel, unit(*direction)});
    }
  return all;
}

/// Exponents of the terms u^p v^q with p + q <= order.
std::vector<std::array<int, 2>> terms(int order) {
  std::vector<std::array<int, 2>> list;
  for (int total = 0; total <= order; ++total)
    for (int p = total; p >= 0; --p) list.push_back({p, total - p});
  return list;
}

/// Least-squares fit of a pair of quantities by polynomials in (u / half u, v / half v); `shift`
/// adds to the first-order terms.
class Polynomials {
 public:
  Polynomials(int order, const std::array<double, 2>& half)
      : list_(terms(order)), order_(order), half_(half) {}

  void add(PixelPosition at, PixelPosition shift, const std::array<double, 2>& value) {
    const double u = at.x_px / half_[0], v = at.y_px / half_[1];
    std::array<double, highest_order + 1> pu{1.0}, pv{1.0};
    for (std::size_t k = 1; k <= std::size_t(order_); ++k) {
      pu[k] = pu[k - 1] * u;
      pv[k] = pv[k - 1] * v;
    }
    for (const auto& [p, q] : list_) {
      double term = pu[std::size_t(p)] * pv[std::size_t(q)];
      if (p + q == 1) term += p ? shift.x_px / half_[0] : shift.y_px / half_[1];
      a_.push_back(term);
    }
    b_.insert(b_.end(), value.begin(), value.end());
  }
  /// Coefficients of u^p v^q, two for each of `list()`.
  std::vector<double> solve() {
    if (b_.size() / 2 < list_.size()) throw Error("fit_wcs: too few pixels see sky");
    auto x = least_squares(std::move(a_), list_.size(), std::move(b_), 2);
    for (std::size_t i = 0; i < list_.size(); ++i) {
      const double unscale = std::pow(half_[0], -list_[i][0]) * std::pow(half_[1], -list_[i][1]);
      x[2 * i] *= unscale;
      x[2 * i + 1] *= unscale;
    }
    return x;
  }
  const std::vector<std::array<int, 2>>& list() const { return list_; }

 private:
  std::vector<std::array<int, 2>> list_;
  int order_;
  std::array<double, 2> half_;
  std::vector<double> a_, b_;
};

/// Samples of one frame and the fit to them.
class Fit {
 public:
  Fit(const Optics& optics, const SkyOfPixel& sky)
      : optics_(optics),
        half_(half_sides_px(optics)),
        samples_(samples_of(optics, sky, fit_points)),
        checks_(samples_of(optics, sky, check_points)) {
    const auto reference = sky(principal_point(optics));
    if (!reference) throw Error("fit_wcs: the frame's centre sees no sky");
    reference_ = unit(*reference);
  }

  Wcs wcs(const WcsForm& form) const;
  const std::vector<Sample>& checks() const { return checks_; }

 private:
  void fit_forward(Wcs& w, const std::vector<PixelPosition>& shifts) const;
  void fit_inverse(Wcs& w, const std::vector<PixelPosition>& shifts) const;
  void choose_table(Wcs& w) const;
  double table_error_px(const Wcs& w) const;
  void measure(Wcs& w) const;

  const Optics& optics_;
  std::array<double, 2> half_;
  std::vector<Sample> samples_, checks_;
  Vec<Gcrs> reference_;
};

/// Position of a direction on the plane of a WCS whose CD matrix is 1 rad per pixel.
std::optional<PixelPosition> on_plane(const Wcs& w, const Vec<Gcrs>& direction) {
  Wcs plain;
  plain.projection = w.projection;
  plain.ra_rad = w.ra_rad;
  plain.dec_rad = w.dec_rad;
  plain.cd_deg = {1.0 / deg, 0.0, 0.0, 1.0 / deg};
  return wcs_focal_place(plain, direction);
}

/// Place of directions that take part in a fit; else empty.
std::optional<PixelPosition> fitted_place(const Wcs& w, const Vec<Gcrs>& direction) {
  if (dot(from_spherical<Gcrs>(w.ra_rad, w.dec_rad), direction) < farthest_fitted_cos)
    return std::nullopt;
  return on_plane(w, direction);
}

void Fit::fit_forward(Wcs& w, const std::vector<PixelPosition>& shifts) const {
  Vec<Gcrs> reference = reference_;
  std::vector<double> c;
  std::vector<std::array<int, 2>> list;
  // The reference direction is moved until the constant term vanishes.
  for (int pass = 0; pass < 4; ++pass) {
    const auto [ra, dec] = to_spherical(reference);
    w.ra_rad = ra;
    w.dec_rad = dec;
    Polynomials polynomials(std::max(1, w.order), half_);
    for (std::size_t i = 0; i < samples_.size(); ++i)
      if (const auto at = fitted_place(w, samples_[i].direction))
        polynomials.add(samples_[i].pixel - PixelPosition{w.crpix_x, w.crpix_y}, shifts[i],
                        {at->x_px, at->y_px});
    list = polynomials.list();
    c = polynomials.solve();
    const double ca = std::cos(ra), sa = std::sin(ra), cd = std::cos(dec), sd = std::sin(dec);
    if (pass < 3)
      reference = unit(reference + Vec<Gcrs>{-sa, ca, 0.0} * c[0] +
                       Vec<Gcrs>{-ca * sd, -sa * sd, cd} * c[1]);
  }
  w.cd_deg = {c[2] / deg, c[4] / deg, c[3] / deg, c[5] / deg};
  const double det = c[2] * c[5] - c[4] * c[3];
  if (!w.order) return;
  const auto side = std::size_t(w.order) + 1;
  for (auto* polynomial : {&w.a, &w.b, &w.ap, &w.bp}) polynomial->assign(side * side, 0.0);
  for (std::size_t i = 3; i < list.size(); ++i) {
    const std::size_t at = std::size_t(list[i][0]) * side + std::size_t(list[i][1]);
    w.a[at] = (c[5] * c[2 * i] - c[4] * c[2 * i + 1]) / det;
    w.b[at] = (c[2] * c[2 * i + 1] - c[3] * c[2 * i]) / det;
  }
}

void Fit::fit_inverse(Wcs& w, const std::vector<PixelPosition>& shifts) const {
  if (!w.order) return;
  Polynomials polynomials(w.order, half_);
  for (std::size_t i = 0; i < samples_.size(); ++i)
    if (fitted_place(w, samples_[i].direction)) {
      const auto focal = wcs_focal_place(w, samples_[i].direction);
      const PixelPosition linear = *focal - shifts[i];
      const PixelPosition by = samples_[i].pixel - PixelPosition{w.crpix_x, w.crpix_y} - linear;
      polynomials.add(linear, {}, {by.x_px, by.y_px});
    }
  const auto& list = polynomials.list();
  const auto c = polynomials.solve();
  const auto side = std::size_t(w.order) + 1;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const std::size_t at = std::size_t(list[i][0]) * side + std::size_t(list[i][1]);
    w.ap[at] = c[2 * i];
    w.bp[at] = c[2 * i + 1];
  }
}

/// Largest error of bilinear values of the table where sky is visible: at the centres of cells
/// spread over the frame and along the horizon.
double Fit::table_error_px(const Wcs& w) const {
  const RefractionShift air(w);
  const double cell = w.refraction->cell_px;
  double worst = 0.0;
  const auto try_cell = [&](PixelPosition near) {
    const double i = std::floor((near.x_px - ShiftTable::first_px) / cell),
                 j = std::floor((near.y_px - ShiftTable::first_px) / cell);
    const PixelPosition corner{ShiftTable::first_px + i * cell, ShiftTable::first_px + j * cell};
    const PixelPosition n00 = air.smooth_at(corner),
                        n10 = air.smooth_at(corner + PixelPosition{cell, 0}),
                        n01 = air.smooth_at(corner + PixelPosition{0, cell}),
                        n11 = air.smooth_at(corner + PixelPosition{cell, cell});
    const auto check = [&](double fx, double fy) {
      const PixelPosition at = corner + PixelPosition{fx * cell, fy * cell};
      if (!(air.elevation_rad(at) >= 0.0)) return;
      const PixelPosition found =
          (n00 * (1 - fx) + n10 * fx) * (1 - fy) + (n01 * (1 - fx) + n11 * fx) * fy;
      const PixelPosition missed = found - air.at(at);
      worst = std::max(worst, std::hypot(missed.x_px, missed.y_px));
    };
    check(0.5, 0.5);
    check((near.x_px - corner.x_px) / cell, (near.y_px - corner.y_px) / cell);
  };
  const PixelPosition first = principal_point(optics_) - PixelPosition{half_[0], half_[1]};
  const PixelPosition step{2 * half_[0] / (table_points - 1), 2 * half_[1] / (table_points - 1)};
  std::array<double, table_points> above{};
  double before = 0.0;
  const auto horizon = [&](PixelPosition from, PixelPosition to, double e_from, double e_to) {
    if ((e_from < 0) == (e_to < 0)) return;
    const PixelPosition at = from + (to - from) * (e_from / (e_from - e_to));
    for (const double along : {-0.4, -0.1, 0.0, 0.1, 0.4})
      try_cell(at + (to - from) * (along * cell / std::max(step.x_px, step.y_px)));
  };
  for (int j = 0; j < table_points; ++j)
    for (int i = 0; i < table_points; ++i) {
      const PixelPosition at = first + PixelPosition{i * step.x_px, j * step.y_px};
      const double e = air.elevation_rad(at);
      if (e >= 0.0 && e < low_rad) try_cell(at);
      if (i > 0) horizon(at - PixelPosition{step.x_px, 0}, at, before, e);
      if (j > 0) horizon(at - PixelPosition{0, step.y_px}, at, above[std::size_t(i)], e);
      before = above[std::size_t(i)] = e;
    }
  return worst;
}

/// Chooses the step of the lookup table, to whose square its error is proportional, and puts the
/// error into `max_px`.
void Fit::choose_table(Wcs& w) const {
  const double longer = std::max(optics_.columns, optics_.rows);
  double& cell = w.refraction->cell_px;
  const double least = std::max(min_cell_px, longer / (max_nodes - 2));
  cell = std::max(least, longer / 48);
  for (int pass = 0; pass < 3; ++pass) {
    const double error = table_error_px(w);
    w.max_px = between_cells * error;
    if (error <= good_table_px || cell <= least) return;
    cell = std::max(least, 0.9 * cell * std::sqrt(good_table_px / error));
  }
  w.max_px = between_cells * table_error_px(w);
}

void Fit::measure(Wcs& w) const {
  std::optional<RefractionShift> air;
  if (w.refraction) air.emplace(w);
  const bool any_sky = air && std::any_of(checks_.begin(), checks_.end(), [&](const Sample& s) {
                         return air->elevation_rad(s.pixel) >= 0.0;
                       });
  Wcs polynomials = w;
  polynomials.refraction.reset();
  double sum = 0.0, worst = 0.0;
  std::size_t count = 0;
  for (const Sample& s : checks_) {
    if (any_sky && air->elevation_rad(s.pixel) < 0.0) continue;
    const auto wanted = wcs_focal_place(w, s.direction);
    if (!wanted) {  // outside the projection: off by more than the frame
      worst = std::max(worst, std::hypot(optics_.columns, optics_.rows));
      continue;
    }
    PixelPosition missed = wcs_focal_place(polynomials, s.pixel) - *wanted;
    if (air) missed = missed + air->at(s.pixel);
    const double error_px = std::hypot(missed.x_px, missed.y_px);
    sum += error_px * error_px;
    worst = std::max(worst, error_px);
    ++count;
  }
  w.max_px += between_points * worst;
  w.rms_px = count ? std::sqrt(sum / double(count)) : w.max_px;
}

Wcs Fit::wcs(const WcsForm& form) const {
  if (form.order < 0 || form.order > highest_order) throw Error("fit_wcs: order must be 0..9");
  const PixelPosition centre = principal_point(optics_);
  Wcs w;
  w.projection = form.projection;
  w.crpix_x = centre.x_px;
  w.crpix_y = centre.y_px;
  w.order = form.order < 2 ? 0 : form.order;
  std::vector<PixelPosition> shifts(samples_.size());
  if (form.refraction) {
    w.refraction = form.refraction;
    w.refraction->offset_x_px = w.refraction->offset_y_px = 0.0;
    if (form.reference_is_refracted) {
      const PixelPosition offset = RefractionShift(w).at(centre);
      w.refraction->offset_x_px = offset.x_px;
      w.refraction->offset_y_px = offset.y_px;
    }
    const RefractionShift air(w);
    for (std::size_t i = 0; i < samples_.size(); ++i) shifts[i] = air.at(samples_[i].pixel);
  }
  fit_forward(w, shifts);
  fit_inverse(w, shifts);
  if (w.refraction) choose_table(w);
  measure(w);
  return w;
}

/// Whether sky and ground are both in the frame.
bool has_horizon(const Optics& optics, const std::vector<Sample>& checks,
                 const std::optional<CameraAir>& air) {
  if (!air) return false;
  bool sky = false, ground = false;
  for (const Sample& s : checks)
    (dot(*unproject(optics, s.pixel), air->zenith) >= 0.0 ? sky : ground) = true;
  return sky && ground;
}

}  // namespace

Wcs fit_wcs(const Optics& optics, const SkyOfPixel& sky, const WcsForm& form) {
  return Fit(optics, sky).wcs(form);
}

Wcs best_wcs(const Optics& optics, const SkyOfPixel& sky, const std::optional<CameraAir>& air) {
  const Fit fit(optics, sky);
  const double half_rad = half_diagonal_rad(optics);
  const bool bent = air && air->refraction.weather().pressure_hpa > 0.0;
  std::vector<WcsForm> forms;
  const Projection plane = optics.projection.fits_plane();
  const bool distorted = !(plane == optics.projection);
  const auto polynomials = [&](const Projection& projection) {
    if (half_rad <= 10 * deg) forms.push_back({.projection = projection, .order = 3});
    forms.push_back({.projection = projection, .order = 5});
    if (distorted) forms.push_back({.projection = projection, .order = highest_order});
  };
  if (!bent || !has_horizon(optics, fit.checks(), air)) {
    if (half_rad <= 45 * deg) polynomials(Projection::gnomonic);
    if (half_rad > 45 * deg || plane != Projection::gnomonic) polynomials(plane);
  }
  if (bent) {
    const Weather& weather = air->refraction.weather();
    WcsForm form{.projection = plane,
                 .order = distorted ? highest_order : 5,
                 .refraction = WcsRefraction{.zenith = air->zenith,
                                             .focal_length_px = optics.focal_length_px(),
                                             .pressure_hpa = weather.pressure_hpa,
                                             .temperature_c = weather.temperature_c,
                                             .humidity = weather.humidity,
                                             .wavelength_um = air->refraction.wavelength_um()}};
    if (distorted) form.refraction->lens = optics.projection;
    forms.push_back(form);
    form.reference_is_refracted = false;
    forms.push_back(form);
  }
  std::optional<Wcs> best;
  for (const WcsForm& form : forms) {
    Wcs w = fit.wcs(form);
    if (!best || w.max_px < best->max_px) best = std::move(w);
    if (best->max_px <= (form.order < 5 ? good_low_order_px : good_px)) break;
  }
  return *best;
}

}  // namespace dmise
