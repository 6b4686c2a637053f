#include "core/detection/trail_light.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double point_length_px = 1e-3;  // shorter is a point: the limit is exact to 1e-7

/// Normal distribution function and density.
struct Normal {
  double cdf = 0.0, pdf = 0.0;
};

/// Both from a table by Taylor's series to third order: 1e-10.
class NormalTable {
 public:
  NormalTable() {
    for (std::size_t i = 0; i < cdf_.size(); ++i) {
      const double x = (double(i) - half) * step;
      cdf_[i] = 0.5 * std::erfc(-x / std::sqrt(2.0));
      pdf_[i] = std::exp(-0.5 * x * x) / std::sqrt(2 * pi);
    }
  }
  Normal operator()(double x) const {
    if (!(x > -reach)) return {0.0, 0.0};
    if (x > reach) return {1.0, 0.0};
    const int i = int(x * (1 / step) + half + 0.5);
    const double x0 = (i - half) * step, h = x - x0, p = pdf_[std::size_t(i)];
    return {cdf_[std::size_t(i)] + p * h * (1 - h * (x0 / 2 - h * (x0 * x0 - 1) / 6)),
            p * (1 - h * (x0 - h * ((x0 * x0 - 1) / 2 - h * x0 * (x0 * x0 - 3) / 6)))};
  }

 private:
  static constexpr double reach = 7.0, step = 1.0 / 64;
  static constexpr int half = 448;  // reach / step
  std::array<double, 2 * half + 1> cdf_{}, pdf_{};
};
const NormalTable normal;

/// A function and its first four derivatives.
struct Derivatives {
  double f, f1, f2, f3, f4;
};

/// Of the Gaussian of sigma 1/s at x/s, whose standard density there is `p`: Hermite's polynomials.
Derivatives of_gaussian(double x, double p, double s) {
  const double x2 = x * x, s2 = s * s, ps = p * s;
  return {ps, -x * ps * s, (x2 - 1) * ps * s2, -x * (x2 - 3) * ps * s2 * s,
          (x2 * (x2 - 6) + 3) * ps * s2 * s2};
}

}  // namespace

TrailLight::TrailLight(const Trail& trail, const Psf& psf)
    : t_(trail),
      cos_(std::cos(trail.angle_rad)),
      sin_(std::sin(trail.angle_rad)),
      parts_(psf.count) {
  // -1/2880 (d^4/dx^4 + d^4/dy^4), turned by the trail's angle.
  constexpr double square = -1.0 / 2880;
  const double c2 = cos_ * cos_, s2 = sin_ * sin_;
  fourth_ = square * (c2 * c2 + s2 * s2);
  mixed_ = square * 12 * c2 * s2;
  odd_ = square * 4 * cos_ * sin_ * (s2 - c2);
  for (std::size_t i = 0; i < parts_; ++i) {
    weight_[i] = psf.parts[i].weight;
    const double sigma_px = psf.parts[i].sigma_px;
    along_[i] = across_[i] = 1 / sigma_px;
    if (psf.along_x == 0.0 && psf.along_diagonal == 0.0) continue;
    // The Gaussian along the line and across it; along it at a place across.
    const double optical = sigma_px * sigma_px - pixel_variance_px2, cc = c2 - s2,
                 cs = 2 * cos_ * sin_;
    const double stretch = optical * (psf.along_x * cc + psf.along_diagonal * cs);
    const double both = optical * (psf.along_diagonal * cc - psf.along_x * cs);
    const double across = sigma_px * sigma_px - stretch;
    lean_[i] = both / across;
    along_[i] = 1 / std::sqrt(sigma_px * sigma_px + stretch - both * lean_[i]);
    across_[i] = 1 / std::sqrt(across);
  }
}

double TrailLight::operator()(double px, double py, TrailDerivatives& d) const {
  const double dx = px - t_.x_px, dy = py - t_.y_px;
  const double along = dx * cos_ + dy * sin_, across = dy * cos_ - dx * sin_;
  const double length = t_.length_px;
  const bool is_point = length < point_length_px;
  double w = 1.0, w_along = 0.0, w_length = 0.0, w_slope = 0.0;
  double bend = 0.0, bend_along = 0.0, bend_length = 0.0, bend_sagitta = 0.0;
  if (!is_point) {
    const double free = 2 * along / length;  // -1 .. 1 from end to end
    const double r = std::clamp(free, -1.0, 1.0);
    const bool inside = r == free;
    w = 1 + t_.slope * r;
    w_slope = r;
    bend_sagitta = 1.0 / 3 - r * r;
    bend = t_.sagitta_px * bend_sagitta;
    if (inside) {
      w_along = t_.slope * 2 / length;
      w_length = -t_.slope * r / length;
      bend_along = -t_.sagitta_px * 4 * r / length;
      bend_length = t_.sagitta_px * 2 * r * r / length;
    }
  }
  const double off = across - bend;
  // Light along the line, per px, times the profile across it, and derivatives of that product.
  double ag = 0.0, along_g = 0.0, length_g = 0.0, ag_off = 0.0;
  for (std::size_t i = 0; i < parts_; ++i) {
    const double s = along_[i], sc = across_[i], v = off * sc, density = normal(v).pdf;
    const double at = along - lean_[i] * off;
    double a, a_along, a_length = 0.0, square = 0.0;
    Normal up, down;
    if (is_point) {
      up = normal(at * s);
      a = up.pdf * s;
      a_along = -at * s * s * a;
    } else {
      up = normal((at + length / 2) * s);
      down = normal((at - length / 2) * s);
      a = (up.cdf - down.cdf) / length;
      a_along = (up.pdf - down.pdf) * s / length;
      a_length = ((up.pdf + down.pdf) * s / 2 - a) / length;
    }
    if (s > 1 / square_below_px) {
      const Derivatives across_line = of_gaussian(v, density, sc);
      Derivatives line;
      if (is_point) {
        line = of_gaussian(at * s, up.pdf, s);
      } else {
        const Derivatives end = of_gaussian((at + length / 2) * s, up.pdf, s);
        const Derivatives start = of_gaussian((at - length / 2) * s, down.pdf, s);
        line = {a, a_along, (end.f1 - start.f1) / length, (end.f2 - start.f2) / length,
                (end.f3 - start.f3) / length};
      }
      square = fourth_ * (line.f4 * across_line.f + line.f * across_line.f4) +
               mixed_ * line.f2 * across_line.f2 +
               odd_ * (line.f3 * across_line.f1 - line.f1 * across_line.f3);
    }
    const double g = weight_[i] * density * sc;
    ag += a * g + weight_[i] * square;
    along_g += a_along * g;
    length_g += a_length * g;
    ag_off -= (a * off * sc * sc + lean_[i] * a_along) * g;
  }
  const double f = t_.flux_e;
  const double by_along = f * (along_g * w + ag * w_along - w * ag_off * bend_along);
  const double by_across = f * w * ag_off;
  d[0] = -by_along * cos_ + by_across * sin_;
  d[1] = -by_along * sin_ - by_across * cos_;
  d[2] = w * ag;
  d[3] = f * (length_g * w + ag * w_length - w * ag_off * bend_length);
  d[4] = by_along * across - by_across * along;
  d[5] = f * ag * w_slope;
  d[6] = -by_across * bend_sagitta;
  return f * d[2];
}

double trail_value(const Trail& trail, const Psf& psf, double x, double y) {
  TrailDerivatives unused{};
  return TrailLight(trail, psf)(x, y, unused);
}

}  // namespace dmise
