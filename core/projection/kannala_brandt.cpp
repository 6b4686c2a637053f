#include "core/projection/kannala_brandt.h"

#include <algorithm>
#include <cmath>

#include "core/projection/first_root.h"

namespace dmise {

KannalaBrandt::KannalaBrandt(const std::array<double, 4>& values) : k_(values) {
  const std::array slope{1.0, 3 * k_[0], 5 * k_[1], 7 * k_[2], 9 * k_[3]};  // by theta^2
  limit_rad_ = std::sqrt(first_root(slope, pi * pi).value_or(pi * pi));
}

double KannalaBrandt::height(double theta_rad) const {
  const double t = theta_rad * theta_rad;
  return theta_rad * (1 + t * (k_[0] + t * (k_[1] + t * (k_[2] + t * k_[3]))));
}

double KannalaBrandt::slope(double theta_rad) const {
  const double t = theta_rad * theta_rad;
  return 1 + t * (3 * k_[0] + t * (5 * k_[1] + t * (7 * k_[2] + t * 9 * k_[3])));
}

std::optional<double> KannalaBrandt::theta_rad(double wanted) const {
  if (!(wanted < rim())) return std::nullopt;
  // Newton's method within a bracket that shrinks.
  double low = 0.0, high = limit_rad_;
  double theta_rad = std::min(wanted, 0.5 * high);
  for (int i = 0; i < 100; ++i) {
    const double over = height(theta_rad) - wanted;
    if (over == 0.0) break;
    (over > 0.0 ? high : low) = theta_rad;
    double next = theta_rad - over / slope(theta_rad);
    if (!(next > low && next < high)) next = 0.5 * (low + high);
    const double step = std::abs(next - theta_rad);
    theta_rad = next;
    if (step <= 1e-16 * theta_rad) break;
  }
  return theta_rad;
}

double KannalaBrandt::area_scale(double theta_rad) const {
  return theta_rad > 0.0 ? std::sin(theta_rad) / (height(theta_rad) * slope(theta_rad)) : 1.0;
}

std::optional<double> KannalaBrandt::per_sine(double x, double y, double z) const {
  const double sine = std::hypot(x, y), theta_rad = std::atan2(sine, z);
  if (!(theta_rad < limit_rad_)) return std::nullopt;
  return sine > 0.0 ? height(theta_rad) / sine : 1.0;
}

}  // namespace dmise
