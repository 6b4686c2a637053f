#include "core/projection/brown_conrady.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/projection/first_root.h"

namespace dmise {
namespace {

constexpr double min_z = 1e-9;  // a gnomonic lens images directions with more

}  // namespace

// With P = hypot(p1, p2) and G the derivative of r R, the determinant of the derivatives at the
// worst position angle is (G - 6 r P)(R - 2 r P) as long as G + 3 R > 16 r P.
BrownConrady::BrownConrady(const std::array<double, 5>& values)
    : c_(values), limit_(std::numeric_limits<double>::infinity()) {
  const auto [k1, k2, k3, p1, p2] = c_;
  const double p = std::hypot(p1, p2);
  for (const auto& positive : {std::array{1.0, -6 * p, 3 * k1, 0.0, 5 * k2, 0.0, 7 * k3},
                               std::array{1.0, -2 * p, k1, 0.0, k2, 0.0, k3},
                               std::array{4.0, -16 * p, 6 * k1, 0.0, 8 * k2, 0.0, 10 * k3}})
    if (const auto root = first_root(positive, 1.0 / min_z)) limit_ = std::min(limit_, *root);
}

double BrownConrady::rim() const { return std::numeric_limits<double>::infinity(); }

std::optional<double> BrownConrady::fold_rad() const {
  return std::isfinite(limit_) ? std::optional(std::atan(limit_)) : std::nullopt;
}

double BrownConrady::height(double theta_rad) const {
  const double r = std::tan(theta_rad), t = r * r;
  return r * (1 + t * (c_[0] + t * (c_[1] + t * c_[2])));
}

BrownConrady::Distorted BrownConrady::distort(Place at) const {
  const auto [k1, k2, k3, p1, p2] = c_;
  const double x = at.x, y = at.y, t = x * x + y * y;
  const double radial = 1 + t * (k1 + t * (k2 + t * k3));
  const double by_t = k1 + t * (2 * k2 + t * 3 * k3);
  return {.x = x * radial + 2 * p1 * x * y + p2 * (t + 2 * x * x),
          .y = y * radial + p1 * (t + 2 * y * y) + 2 * p2 * x * y,
          .xx = radial + 2 * x * x * by_t + 2 * p1 * y + 6 * p2 * x,
          .xy = 2 * x * y * by_t + 2 * p1 * x + 2 * p2 * y,
          .yy = radial + 2 * y * y * by_t + 6 * p1 * y + 2 * p2 * x};
}

// Newton's method; a step that leaves the disc or does not reduce the distance is halved.
std::optional<BrownConrady::Place> BrownConrady::undistort(Place wanted) const {
  const double r = std::hypot(wanted.x, wanted.y);
  const double inside = r < 0.5 * limit_ ? 1.0 : 0.5 * limit_ / r;
  Place at{wanted.x * inside, wanted.y * inside};
  Distorted now = distort(at);
  double missed = std::hypot(wanted.x - now.x, wanted.y - now.y);
  for (int step = 0; step < 200 && missed > 1e-16 * r; ++step) {
    const double dx = wanted.x - now.x, dy = wanted.y - now.y;
    const double determinant = now.xx * now.yy - now.xy * now.xy;
    const Place by{(now.yy * dx - now.xy * dy) / determinant,
                   (now.xx * dy - now.xy * dx) / determinant};
    bool nearer = false;
    for (double part = 1.0; part > 1e-9 && !nearer; part *= 0.5) {
      const Place to{at.x + part * by.x, at.y + part * by.y};
      if (!(std::hypot(to.x, to.y) < limit_)) continue;
      const Distorted there = distort(to);
      const double left = std::hypot(wanted.x - there.x, wanted.y - there.y);
      if (!(left < missed)) continue;
      nearer = true;
      at = to;
      now = there;
      missed = left;
    }
    if (!nearer) break;
  }
  return missed <= 1e-13 * (1 + r) ? std::optional(at) : std::nullopt;
}

std::optional<double> BrownConrady::axis_angle_rad(double x, double y) const {
  const auto at = undistort({x, y});
  return at ? std::optional(std::atan(std::hypot(at->x, at->y))) : std::nullopt;
}

std::optional<std::array<double, 3>> BrownConrady::direction_of(double x, double y) const {
  const auto at = undistort({x, y});
  if (!at) return std::nullopt;
  const double length = std::sqrt(at->x * at->x + at->y * at->y + 1.0);
  return std::array{at->x / length, at->y / length, 1.0 / length};
}

std::optional<std::array<double, 2>> BrownConrady::image_of(double x, double y, double z) const {
  if (!(z > min_z)) return std::nullopt;
  const Place at{x / z, y / z};
  if (!(std::hypot(at.x, at.y) < limit_)) return std::nullopt;
  const Distorted image = distort(at);
  return std::array{image.x, image.y};
}

double BrownConrady::pixel_solid_angle_sr(double x_px, double y_px, double f_px) const {
  const auto at = undistort({x_px / f_px, y_px / f_px});
  if (!at) return 0.0;
  const Distorted d = distort(*at);
  const double stretch = d.xx * d.yy - d.xy * d.xy;
  return std::pow(1.0 + at->x * at->x + at->y * at->y, -1.5) / stretch / (f_px * f_px);
}

}  // namespace dmise
