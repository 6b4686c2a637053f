#pragma once
#include <array>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/units.h"
#include "core/projection/axially_symmetric.h"

// The projections that need no coefficients. FITS has each by name (Calabretta & Greisen 2002, A&A
// 395, 1077).
namespace dmise {

template <class Lens>
struct Classical : AxiallySymmetric<Lens> {
  static constexpr std::array<ProjectionCoefficient, 0> coefficients{};
  static constexpr double widest_field_rad = 220 * deg;
  double rim() const { return std::numeric_limits<double>::infinity(); }
  std::optional<double> fold_rad() const { return std::nullopt; }
  bool operator==(const Classical &) const = default;
};

struct Gnomonic : Classical<Gnomonic> {
  static constexpr const char *name = "gnomonic", *fits_code = "TAN";
  static constexpr double widest_field_rad = 170 * deg;

  double height(double theta_rad) const { return std::tan(theta_rad); }
  std::optional<double> theta_rad(double height) const { return std::atan(height); }
  double area_scale(double theta_rad) const { return std::pow(std::cos(theta_rad), 3); }
  std::optional<double> per_sine(double, double, double z) const {
    return z > 1e-9 ? std::optional(1.0 / z) : std::nullopt;
  }
  std::optional<std::array<double, 3>> direction_of(double x, double y) const {
    const double length = std::sqrt(x * x + y * y + 1.0);
    return std::array{x / length, y / length, 1.0 / length};
  }
  bool operator==(const Gnomonic &) const = default;
};

struct Equidistant : Classical<Equidistant> {
  static constexpr const char *name = "equidistant", *fits_code = "ARC";

  double rim() const { return pi; }
  double height(double theta_rad) const { return theta_rad; }
  std::optional<double> theta_rad(double height) const {
    return height < pi ? std::optional(height) : std::nullopt;
  }
  double area_scale(double theta_rad) const {
    return theta_rad > 0.0 ? std::sin(theta_rad) / theta_rad : 1.0;
  }
  std::optional<double> per_sine(double x, double y, double z) const {
    const double sine = std::hypot(x, y);
    return sine > 0.0 ? std::atan2(sine, z) / sine : 1.0;
  }
  bool operator==(const Equidistant &) const = default;
};

struct Equisolid : Classical<Equisolid> {
  static constexpr const char *name = "equisolid", *fits_code = "ZEA";

  double rim() const { return 2.0; }
  double height(double theta_rad) const { return 2 * std::sin(theta_rad / 2); }
  std::optional<double> theta_rad(double height) const {
    return height < 2.0 ? std::optional(2 * std::asin(height / 2)) : std::nullopt;
  }
  double area_scale(double) const { return 1.0; }
  std::optional<double> per_sine(double, double, double z) const {
    return std::sqrt(2.0 / (1.0 + z));
  }
  bool operator==(const Equisolid &) const = default;
};

struct Stereographic : Classical<Stereographic> {
  static constexpr const char *name = "stereographic", *fits_code = "STG";

  double height(double theta_rad) const { return 2 * std::tan(theta_rad / 2); }
  std::optional<double> theta_rad(double height) const { return 2 * std::atan(height / 2); }
  double area_scale(double theta_rad) const { return std::pow(std::cos(theta_rad / 2), 4); }
  std::optional<double> per_sine(double, double, double z) const { return 2.0 / (1.0 + z); }
  bool operator==(const Stereographic &) const = default;
};

}  // namespace dmise
