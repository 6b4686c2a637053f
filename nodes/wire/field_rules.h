#pragma once
#include <array>
#include <cmath>
#include <cstddef>
#include <span>
#include <string>

#include "core/base/units.h"
#include "core/frames/vec.h"

// What numbers and texts in fields of messages must be. All throw `Refused`, with the field's name.
namespace dmise::field_rules {

inline constexpr double angle_limit_rad = 2 * pi;  // right ascensions may start at -pi or 0
inline constexpr double latitude_limit_rad = pi / 2 * (1 + 1e-12);

[[noreturn]] void refuse(const std::string& field, const std::string& reason);
void finite(double value, const char* field);
void in_range(double value, double low, double high, const char* field);
void not_negative(double value, const char* field);
void direction(double ra_rad, double dec_rad, const char* field);
/// Each value in [-limit, limit].
void all_within(std::span<const double> values, double limit, const char* field);
/// A 2x2 covariance as variance, covariance, variance.
void covariance(const std::array<double, 3>& c, const char* field);
/// The lower triangle of a 6x6 covariance, row by row: finite, no negative variance.
void covariance(const std::array<double, 21>& c, const char* field);
/// `limit`: in bytes.
void utf8(const std::string& text, std::size_t limit, const char* field);
void name_text(const std::string& text, const char* field);

template <class F>
void vector_within(const Vec<F>& v, double limit, const char* field) {
  all_within(std::array{v.x, v.y, v.z}, limit, field);
}

template <class To, class From>
void rotates(const Rotation<To, From>& r, const char* field) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      double product = 0;
      for (int k = 0; k < 3; ++k) product += r.m[i][k] * r.m[j][k];
      if (!(std::abs(product - (i == j)) < 1e-9)) refuse(field, "rows must be orthonormal");
    }
  const Vec<To> x{r.m[0][0], r.m[0][1], r.m[0][2]}, y{r.m[1][0], r.m[1][1], r.m[1][2]},
      z{r.m[2][0], r.m[2][1], r.m[2][2]};
  if (!(dot(cross(x, y), z) > 0)) refuse(field, "must be right-handed");
}

}  // namespace dmise::field_rules
