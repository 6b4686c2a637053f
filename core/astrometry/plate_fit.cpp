#include "core/astrometry/plate_fit.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/algebra/positive_matrix.h"
#include "core/base/algebra/symmetric2.h"

namespace dmise {
namespace {

constexpr int max_steps = 12, max_passes = 12;
constexpr int soft_passes = 4;  // with Huber's weights, if there are outliers
constexpr double huber = 1.5;
/// Terms of order 3 whose sum, with one coefficient, is radial.
constexpr std::array<std::size_t, 4> radial_terms{8, 11, 12, 15};

/// Derivatives of a residual along x and y by the free parameters, each in units that move an image
/// by about a pixel, and the residual.
struct Row {
  std::vector<PixelPosition> by;
  PixelPosition residual;
};

class Equations {
 public:
  Equations(const PlateModel& model, const PlateFreedom& free) : model_(model), free_(free) {}

  /// Works out the row of a match. False if the direction has no image.
  bool row(const Vec<Gcrs>& direction, PixelPosition pixel, Row& row) {
    const Vec<CameraFrame> c = model_.camera_from_gcrs * direction;
    const auto place = model_.focal_place(c);
    if (!place) return false;
    const PixelPosition at = pixel - model_.centre;
    row.by.clear();
    constexpr double step = 1e-6;
    for (const Vec<CameraFrame>& axis : {Vec<CameraFrame>{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}) {
      const auto more = model_.focal_place(unit(c + cross(axis, c) * step));
      const auto less = model_.focal_place(unit(c - cross(axis, c) * step));
      if (!more || !less) return false;
      row.by.push_back((*less - *more) * (0.5 / step / model_.focal_length_px));
    }
    if (free_.focal_length) row.by.push_back(*place * (-1 / model_.unit_px));
    if (free_.centre) {
      row.by.push_back({-1, 0});
      row.by.push_back({0, -1});
    }
    PixelPosition undistorted = at;
    distortion_terms(model_.order, at.x_px / model_.unit_px, at.y_px / model_.unit_px, moves_);
    for (std::size_t i = 0; i < moves_.size(); ++i)
      undistorted = undistorted + moves_[i] * model_.distortion[i];
    if (free_.order > 0) row.by.insert(row.by.end(), moves_.begin(), moves_.end());
    if (free_.radial) {
      PixelPosition sum{};
      for (const std::size_t term : radial_terms) sum = sum + moves_[term];
      row.by.push_back(sum);
    }
    row.residual = undistorted - *place;
    return true;
  }
  /// Unit of a parameter in the equations over that of the result.
  double unit_of(int parameter) const {
    if (parameter < 3) return model_.focal_length_px;
    return parameter == 3 && free_.focal_length ? model_.unit_px : 1.0;
  }
  PlateModel moved(const std::vector<double>& by) const {
    PlateModel m = model_;
    std::size_t i = 3;
    m.camera_from_gcrs =
        turned(m.camera_from_gcrs, Vec<CameraFrame>{by[0], by[1], by[2]} / m.focal_length_px);
    if (free_.focal_length) m.focal_length_px *= std::exp(by[i++] / m.unit_px);
    if (free_.centre) {
      m.centre = m.centre + PixelPosition{by[i], by[i + 1]};
      i += 2;
    }
    if (free_.order > 0)
      for (double& c : m.distortion) c += by[i++];
    if (free_.radial)
      for (const std::size_t term : radial_terms) m.distortion[term] += by[i];
    return m;
  }

 private:
  const PlateModel& model_;
  PlateFreedom free_;
  std::vector<PixelPosition> moves_;
};

/// Inverse of a match's covariance.
Symmetric2 weight_of(const PlateMatch& m, double min_sigma_px) {
  const auto& [xx, xy, yy] = m.covariance_px2;
  const double more = min_sigma_px * min_sigma_px + 1e-12;
  return inverse_of(Symmetric2{xx + more, xy, yy + more});
}

double square(const Symmetric2& w, PixelPosition r) { return quadratic_form(w, r.x_px, r.y_px); }

/// Median of squared residuals over that of chi-square with two degrees of freedom.
double spread2(std::span<const double> all, std::span<const PlateMatch> matches) {
  std::vector<double> squares;
  for (std::size_t k = 0; k < all.size(); ++k)
    if (!matches[k].ignored) squares.push_back(all[k]);
  if (squares.empty()) return 0.0;
  const auto middle = squares.begin() + std::ptrdiff_t(squares.size() / 2);
  std::nth_element(squares.begin(), middle, squares.end());
  return *middle / (2 * std::log(2.0));
}

}  // namespace

std::optional<PlateFit> fit_plate(const PlateModel& model, std::span<const PlateMatch> matches,
                                  const PlateFreedom& free, const PlateFitSettings& settings) {
  const int n = free.size();
  const auto side = std::size_t(n);
  PlateFit fit{.model = model, .free = free, .used = std::vector<char>(matches.size(), 1)};
  if (const int order = free.radial ? 3 : free.order; order > 0) {
    fit.model.order = order;
    fit.model.distortion.resize(std::size_t(distortion_size(order)), 0.0);
  }
  std::vector<std::array<double, 3>> weight;
  for (std::size_t k = 0; k < matches.size(); ++k) {
    weight.push_back(weight_of(matches[k], settings.min_sigma_px));
    fit.used[k] = !matches[k].ignored;
  }
  std::vector<double> squares(matches.size()), soft(matches.size(), 1.0);
  Row row;
  for (int pass = 0; pass < max_passes; ++pass) {
    for (int step = 0; step < max_steps; ++step) {
      Equations equations(fit.model, free);
      std::vector<double> normal(side * side, 0.0), right(side, 0.0), by(side, 0.0);
      fit.count = 0;
      fit.chi2 = 0.0;
      double sum2 = 0.0;
      for (std::size_t k = 0; k < matches.size(); ++k) {
        if (!equations.row(matches[k].direction, matches[k].pixel, row)) {
          fit.used[k] = 0;
          squares[k] = 1e300;
          continue;
        }
        auto w = weight[k];
        squares[k] = square(w, row.residual);
        if (!fit.used[k]) continue;
        for (double& part : w) part *= soft[k];
        ++fit.count;
        fit.chi2 += squares[k];
        sum2 += row.residual.x_px * row.residual.x_px + row.residual.y_px * row.residual.y_px;
        for (std::size_t i = 0; i < side; ++i) {
          const double wx = w[0] * row.by[i].x_px + w[1] * row.by[i].y_px;
          const double wy = w[1] * row.by[i].x_px + w[2] * row.by[i].y_px;
          right[i] -= wx * row.residual.x_px + wy * row.residual.y_px;
          for (std::size_t j = 0; j <= i; ++j)
            normal[i * side + j] += wx * row.by[j].x_px + wy * row.by[j].y_px;
        }
      }
      if (2 * fit.count < n) return std::nullopt;
      fit.rms_px = std::sqrt(sum2 / fit.count);
      for (std::size_t i = 0; i < side; ++i)
        for (std::size_t j = 0; j < i; ++j) normal[j * side + i] = normal[i * side + j];
      if (!invert_positive(normal, n)) return std::nullopt;
      double gain = 0.0;
      for (std::size_t i = 0; i < side; ++i) {
        for (std::size_t j = 0; j < side; ++j) by[i] += normal[i * side + j] * right[j];
        gain += by[i] * right[i];
      }
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j)
          normal[std::size_t(i) * side + std::size_t(j)] /=
              equations.unit_of(i) * equations.unit_of(j);
      fit.covariance = std::move(normal);
      if (gain < 1e-7) break;
      if (!std::isfinite(gain) || std::hypot(by[0], by[1], by[2]) > fit.model.focal_length_px)
        return std::nullopt;
      fit.model = equations.moved(by);
    }
    const int degrees = 2 * fit.count - n;
    const double scale2 =
        degrees > 0 ? std::max(1.0, std::min(fit.chi2 / degrees, 1.5 * spread2(squares, matches)))
                    : 1.0;
    fit.error_scale = std::sqrt(scale2);
    const double limit = settings.outlier_sigmas * settings.outlier_sigmas * scale2;
    bool changed = false;
    if (pass < soft_passes) {
      const double core = huber * huber * std::max(1e-12, spread2(squares, matches));
      const bool outliers = *std::max_element(squares.begin(), squares.end()) >
                            settings.outlier_sigmas * settings.outlier_sigmas;
      const bool again = outliers && pass + 1 < soft_passes && degrees > 0;
      for (std::size_t k = 0; k < matches.size(); ++k)
        soft[k] = again ? std::min(1.0, std::sqrt(core / std::max(squares[k], 1e-300))) : 1.0;
      if (again) continue;
      pass = soft_passes;
    }
    for (std::size_t k = 0; k < matches.size(); ++k) {
      const char use = !matches[k].ignored && squares[k] <= limit;
      changed = changed || use != fit.used[k];
      fit.used[k] = use;
    }
    if (!changed) break;
  }
  for (double& c : fit.covariance) c *= fit.error_scale * fit.error_scale;
  return fit;
}

double PlateFit::sigma_px(const Vec<Gcrs>& direction, PixelPosition pixel) const {
  Equations equations(model, free);
  Row row;
  if (!equations.row(direction, pixel, row)) return 0.0;
  const int n = free.size();
  double sum = 0.0;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const PixelPosition a = row.by[std::size_t(i)], b = row.by[std::size_t(j)];
      sum += (a.x_px * b.x_px + a.y_px * b.y_px) * covariance[std::size_t(i * n + j)] *
             equations.unit_of(i) * equations.unit_of(j);
    }
  return std::sqrt(std::max(sum, 0.0) / 2);
}

}  // namespace dmise
