#include "core/camera_calibration/lens_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/algebra/positive_matrix.h"
#include "core/base/algebra/symmetric2.h"
#include "core/base/error.h"
#include "core/base/numeric/chi_square.h"
#include "core/base/numeric/quantile.h"

namespace dmise {
namespace {

constexpr double lens_outlier_sigmas = 4.5;
constexpr double shown_sigmas = 3.1;

/// A lens with its frames' attitudes: the focal length, and the first coefficients that are free.
struct LensModel {
  std::size_t projection = 0;  // in the table
  std::vector<double> coefficients;
  std::size_t free = 0;
  double focal_px = 0.0;
  PixelPosition middle;
  std::vector<Rotation<CameraFrame, Gcrs>> attitudes;

  Projection lens() const { return Projection::make(projection, coefficients); }
  std::size_t shared() const { return 1 + free; }
};

struct LensState {
  std::vector<double> normal, right;             // what is shared, without the attitudes
  std::vector<std::array<double, 12>> attitude;  // by frames: inverse 3 x 3, right hand
  std::vector<std::vector<double>> mixed;        // by frames: shared x 3
  double chi2 = 0.0, squares_px2 = 0.0;
  int stars = 0;
};

using Used = std::vector<std::vector<char>>;

/// Image places of a direction, in pixels, and its derivatives: by the shared terms, then the
/// attitude.
bool lens_row(const LensModel& model, const Projection& lens, const std::vector<Projection>& more,
              const Vec<CameraFrame>& c, PixelPosition& place, std::vector<PixelPosition>& by) {
  constexpr double step = 1e-6;
  const auto at = [&](const Projection& p,
                      const Vec<CameraFrame>& d) -> std::optional<PixelPosition> {
    const auto image = p.image_of(d.x, d.y, d.z);
    if (!image) return std::nullopt;
    return PixelPosition{(*image)[0] * model.focal_px, (*image)[1] * model.focal_px};
  };
  const auto here = at(lens, c);
  if (!here) return false;
  place = *here;
  by.assign(1, place * (1 / model.focal_px));
  for (std::size_t k = 0; k < more.size(); ++k) {
    const auto moved = at(more[k], c);
    if (!moved) return false;
    by.push_back((*moved - place) * (1 / step));
  }
  for (const Vec<CameraFrame>& axis : {Vec<CameraFrame>{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
    const auto up = at(lens, unit(c + cross(axis, c) * step));
    const auto down = at(lens, unit(c - cross(axis, c) * step));
    if (!up || !down) return false;
    by.push_back((*up - *down) * (0.5 / step));
  }
  return true;
}

double weighted(const Symmetric2& w, PixelPosition a, PixelPosition b) {
  return w[0] * a.x_px * b.x_px + w[1] * (a.x_px * b.y_px + a.y_px * b.x_px) +
         w[2] * a.y_px * b.y_px;
}

Symmetric2 weight_of(const PlateMatch& m) {
  constexpr double least = 1e-8;
  const auto& [xx, xy, yy] = m.covariance_px2;
  return inverse_of(Symmetric2{xx + least, xy, yy + least});
}

std::optional<LensState> lens_state(const std::vector<LensFrame>& frames, const LensModel& model,
                                    const Used& used) {
  constexpr double step = 1e-6;
  const std::size_t n = model.shared();
  const Projection lens = model.lens();
  std::vector<Projection> more;
  for (std::size_t k = 0; k < model.free; ++k) {
    auto moved = model.coefficients;
    moved[k] += step;
    more.push_back(Projection::make(model.projection, moved));
  }
  LensState out{.normal = std::vector<double>(n * n, 0.0), .right = std::vector<double>(n, 0.0)};
  std::vector<PixelPosition> by;
  PixelPosition place;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    std::vector<double> own(9, 0.0), mixed(n * 3, 0.0);
    std::array<double, 3> right{};
    for (std::size_t k = 0; k < frames[f].matches.size(); ++k) {
      const PlateMatch& m = frames[f].matches[k];
      if (!used[f][k] || !lens_row(model, lens, more, model.attitudes[f] * m.direction, place, by))
        continue;
      const Symmetric2 w = weight_of(m);
      const PixelPosition off = m.pixel - model.middle - place;
      out.chi2 += weighted(w, off, off);
      out.squares_px2 += off.x_px * off.x_px + off.y_px * off.y_px;
      ++out.stars;
      for (std::size_t a = 0; a < n; ++a) {
        out.right[a] += weighted(w, by[a], off);
        for (std::size_t b = 0; b < n; ++b) out.normal[a * n + b] += weighted(w, by[a], by[b]);
        for (std::size_t b = 0; b < 3; ++b) mixed[a * 3 + b] += weighted(w, by[a], by[n + b]);
      }
      for (std::size_t a = 0; a < 3; ++a) {
        right[a] += weighted(w, by[n + a], off);
        for (std::size_t b = 0; b < 3; ++b) own[a * 3 + b] += weighted(w, by[n + a], by[n + b]);
      }
    }
    if (!invert_positive(own, 3)) return std::nullopt;
    std::array<double, 12> attitude{};
    std::ranges::copy(own, attitude.begin());
    std::ranges::copy(right, attitude.begin() + 9);
    // What the frame's attitude takes away.
    for (std::size_t a = 0; a < n; ++a)
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) {
          const double part = mixed[a * 3 + i] * own[i * 3 + j];
          out.right[a] -= part * right[j];
          for (std::size_t b = 0; b < n; ++b) out.normal[a * n + b] -= part * mixed[b * 3 + j];
        }
    out.attitude.push_back(attitude);
    out.mixed.push_back(std::move(mixed));
  }
  return out;
}

/// A model at its least squares, with the covariance of what is shared.
struct LensSolution {
  LensModel model;
  std::vector<double> covariance;
  double chi2 = 0.0, scale2 = 1.0, rms_px = 0.0;
  int stars = 0;
};

std::optional<LensSolution> solve_lens(const std::vector<LensFrame>& frames, LensModel model,
                                       const Used& used) {
  LensSolution out{.model = std::move(model)};
  const std::size_t n = out.model.shared();
  for (int step = 0; step < 20; ++step) {
    const auto state = lens_state(frames, out.model, used);
    const int degrees = state ? 2 * state->stars - int(n + 3 * frames.size()) : 0;
    if (degrees < 4) return std::nullopt;
    auto covariance = state->normal;
    if (!invert_positive(covariance, int(n))) return std::nullopt;
    std::vector<double> by(n, 0.0);
    double gain = 0.0;
    for (std::size_t a = 0; a < n; ++a) {
      for (std::size_t b = 0; b < n; ++b) by[a] += covariance[a * n + b] * state->right[b];
      gain += by[a] * state->right[a];
    }
    for (std::size_t f = 0; f < frames.size(); ++f) {
      std::array<double, 3> turn{}, right{};
      for (std::size_t i = 0; i < 3; ++i) {
        right[i] = state->attitude[f][9 + i];
        for (std::size_t a = 0; a < n; ++a) right[i] -= state->mixed[f][a * 3 + i] * by[a];
      }
      for (std::size_t i = 0; i < 3; ++i)
        for (std::size_t j = 0; j < 3; ++j) turn[i] += state->attitude[f][i * 3 + j] * right[j];
      out.model.attitudes[f] =
          turned(out.model.attitudes[f], Vec<CameraFrame>{turn[0], turn[1], turn[2]});
    }
    out.model.focal_px += by[0];
    for (std::size_t k = 0; k < out.model.free; ++k) out.model.coefficients[k] += by[k + 1];
    constexpr double few = 50.0;
    out.chi2 = state->chi2, out.stars = state->stars;
    out.scale2 = state->chi2 / degrees;
    if (degrees < few) out.scale2 = std::max(1.0, out.scale2);
    out.rms_px = std::sqrt(state->squares_px2 / state->stars);
    out.covariance = std::move(covariance);
    if (step > 1 && gain < 1e-6) break;
  }
  for (double& c : out.covariance) c *= out.scale2;
  return out;
}

/// Takes stars out that are far from where the lens has them.
void drop_outliers(const std::vector<LensFrame>& frames, const LensSolution& fit, Used& used) {
  const Projection lens = fit.model.lens();
  std::vector<PixelPosition> by;
  PixelPosition place;
  std::vector<double> all;
  std::vector<std::vector<double>> squares;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    squares.emplace_back();
    for (const PlateMatch& m : frames[f].matches) {
      double square = HUGE_VAL;
      if (lens_row(fit.model, lens, {}, fit.model.attitudes[f] * m.direction, place, by)) {
        const PixelPosition off = m.pixel - fit.model.middle - place;
        square = weighted(weight_of(m), off, off);
        all.push_back(square);
      }
      squares.back().push_back(square);
    }
  }
  if (all.empty()) return;
  const double scale2 = std::max(1.0, median_of(all) / (2 * std::log(2.0)));
  for (std::size_t f = 0; f < frames.size(); ++f)
    for (std::size_t k = 0; k < squares[f].size(); ++k)
      used[f][k] = squares[f][k] < lens_outlier_sigmas * lens_outlier_sigmas * scale2;
}

/// By how much the focal lengths of single frames scatter more than their stars: of the mean.
double focal_by_frames(const std::vector<LensFrame>& frames, const LensSolution& all,
                       const Used& used) {
  double chi2 = 0.0, squares = 0.0, n = 0.0;
  for (std::size_t f = 0; f < frames.size(); ++f) {
    LensModel one = all.model;
    one.free = 0;
    one.attitudes = {all.model.attitudes[f]};
    const auto fit = solve_lens({frames[f]}, one, {used[f]});
    if (!fit) continue;
    const double off = fit->model.focal_px - all.model.focal_px;
    chi2 += off * off / fit->covariance[0];
    squares += off * off, ++n;
  }
  if (n < 2 || chi2 < chi_square_of_normal(shown_sigmas, n - 1)) return 0.0;
  return std::sqrt(squares / (n - 1) / n);
}

}  // namespace

std::optional<LensFit> fit_lens(const std::vector<LensFrame>& frames, const Projection& projection,
                                double focal_length_px, int columns, int rows) try {
  constexpr std::size_t max_terms = 2;
  LensModel model{
      .projection = projection.index(),
      .coefficients = {projection.coefficients().begin(), projection.coefficients().end()},
      .focal_px = focal_length_px,
      .middle = {0.5 * (columns - 1), 0.5 * (rows - 1)}};
  Used used;
  for (const LensFrame& frame : frames) {
    model.attitudes.push_back(frame.camera_from_gcrs);
    used.emplace_back(frame.matches.size(), 1);
  }
  const bool flat = std::string_view(projection.name()) == "gnomonic" ||
                    std::string_view(projection.name()) == "brown_conrady";
  const std::size_t family = *Projection::index_of_name(flat ? "brown_conrady" : "kannala_brandt");
  auto best = solve_lens(frames, model, used);
  if (!best) return std::nullopt;
  LensFit out;
  std::optional<LensSolution> first;  // with one term
  LensModel next = best->model;
  next.projection = family;
  next.coefficients.assign(Projection::rows()[family].coefficients.size(), 0.0);
  for (std::size_t terms = 1; terms <= max_terms; ++terms) {
    next.free = terms;
    auto more = solve_lens(frames, next, used);
    if (!more) break;
    drop_outliers(frames, *more, used);
    more = solve_lens(frames, more->model, used);
    if (!more) break;
    best = solve_lens(frames, best->model, used);
    if (!best) return std::nullopt;
    if (terms == 1) first = more;
    next = more->model;
    const double gain = (best->chi2 - more->chi2) / more->scale2;
    if (gain > chi_square_of_normal(shown_sigmas, double(more->model.free - best->model.free)))
      best = more;
  }
  const LensSolution& shown = *best;
  out.projection = shown.model.lens();
  out.distorted = shown.model.free > 0;
  out.rms_px = shown.rms_px;
  out.focal_length_px = {shown.model.focal_px, std::hypot(std::sqrt(shown.covariance[0]),
                                                          focal_by_frames(frames, shown, used))};
  const LensSolution& terms = out.distorted || !first ? shown : *first;
  for (std::size_t k = 0; k < terms.model.free; ++k)
    out.coefficients.push_back({terms.model.coefficients[k],
                                std::sqrt(terms.covariance[(k + 1) * (terms.model.shared() + 1)])});
  return out;
} catch (const Error&) {
  return std::nullopt;
}

}  // namespace dmise
