#pragma once
#include <array>
#include <span>

#include "core/base/units.h"
#include "core/projection/axially_symmetric.h"

namespace dmise {

/// A calibrated fisheye: r = theta + k1 theta^3 + k2 theta^5 + k3 theta^7 + k4 theta^9 in focal
/// lengths, the fisheye model of OpenCV extended beyond 90 deg. Directions beyond the angle at
/// which r stops rising have no image. The FITS projection is the polynomial ZPN. Source: Kannala &
/// Brandt 2006, IEEE Trans. Pattern Anal. Mach. Intell. 28, 1335, expression 6.
class KannalaBrandt : public AxiallySymmetric<KannalaBrandt> {
 public:
  static constexpr const char *name = "kannala_brandt", *fits_code = "ZPN";
  static constexpr double widest_field_rad = 220 * deg;
  static constexpr std::array<ProjectionCoefficient, 4> coefficients{{
      {.key = "k1", .card = "LENSK1", .pv = 3, .most = 1e3, .comment = "of theta^3"},
      {.key = "k2", .card = "LENSK2", .pv = 5, .most = 1e3, .comment = "of theta^5"},
      {.key = "k3", .card = "LENSK3", .pv = 7, .most = 1e3, .comment = "of theta^7"},
      {.key = "k4", .card = "LENSK4", .pv = 9, .most = 1e3, .comment = "of theta^9"},
  }};

  explicit KannalaBrandt(const std::array<double, 4>& values);

  std::span<const double> values() const { return k_; }
  double rim() const { return height(limit_rad_); }
  std::optional<double> fold_rad() const {
    return limit_rad_ < pi ? std::optional(limit_rad_) : std::nullopt;
  }
  double height(double theta_rad) const;
  std::optional<double> theta_rad(double height) const;
  double area_scale(double theta_rad) const;
  std::optional<double> per_sine(double x, double y, double z) const;
  bool operator==(const KannalaBrandt& other) const { return k_ == other.k_; }

 private:
  double slope(double theta_rad) const;

  std::array<double, 4> k_;
  double limit_rad_;  // at most pi
};

}  // namespace dmise
