#include "core/forces/gravity_field.h"

#include <array>
#include <cmath>
#include <cstdint>

#include "core/base/error.h"
#include "core/orbit/two_body.h"

namespace dmise {
namespace {

struct Term {
  std::int64_t c, s;
};
constexpr Term egm2008_terms[] = {
#include "core/forces/egm2008_terms.inc"
};
constexpr double step_of_terms = 1e-15, egm2008_radius_m = 6378136.3;
static_assert(std::size(egm2008_terms) ==
              (GravityField::highest_degree + 1) * (GravityField::highest_degree + 2) / 2 - 3);

constexpr std::size_t width = GravityField::highest_degree + 2;
using Orders = std::array<double, width>;

/// Sums over the degrees, of each order.
struct Sums {
  Orders c{}, s{}, degree_c{}, degree_s{}, derivative_c{}, derivative_s{};
};

/// Adds the terms of degree `n`. `b`: its Legendre functions.
void add_degree(int n, const double* b, const double* c, const double* s, const double* derivative,
                Sums& sums) {
  const double degree_and_one = n + 1;
  for (int m = 0; m <= n; ++m) {
    const double x = b[m] * c[m], y = b[m] * s[m], slope = b[m + 1] * derivative[m];
    sums.c[std::size_t(m)] += x;
    sums.s[std::size_t(m)] += y;
    sums.degree_c[std::size_t(m)] += degree_and_one * x;
    sums.degree_s[std::size_t(m)] += degree_and_one * y;
    sums.derivative_c[std::size_t(m)] += slope * c[m];
    sums.derivative_s[std::size_t(m)] += slope * s[m];
  }
}

}  // namespace

GravityField::GravityField(int degree) : degree_(degree) {
  if (degree != 0 && (degree < 2 || degree > highest_degree))
    throw Error("degree of gravity: must be 0 or 2 to 70, got " + std::to_string(degree));
  const Term* term = egm2008_terms;
  for (int i = 0; i <= degree; ++i) {
    const double n = i;
    rows_.push_back({c_.size(), i == 0 ? 1.0 : i == 1 ? std::sqrt(3.0) : std::sqrt(1 + 0.5 / n)});
    for (int j = 0; j <= i; ++j) {
      const double m = j;
      const bool has_two = j <= i - 2;
      ahead_.push_back(j < i ? std::sqrt((2 * n + 1) * (2 * n - 1) / ((n - m) * (n + m))) : 0.0);
      behind_.push_back(has_two ? std::sqrt((2 * n + 1) * (n + m - 1) * (n - m - 1) /
                                            ((2 * n - 3) * (n + m) * (n - m)))
                                : 0.0);
      derivative_.push_back(std::sqrt((n - m) * (n + m + 1) * (j == 0 ? 0.5 : 1.0)));
      c_.push_back(i < 2 ? 0.0 : double(term->c) * step_of_terms);
      s_.push_back(i < 2 ? 0.0 : double(term->s) * step_of_terms);
      if (i >= 2) ++term;
    }
  }
}

// Pines 1973, AIAA Journal 11, 1508, with normalised functions (Lundberg & Schutz 1988, JGCD 11,
// 31): no pole is singular. `b` is the function times (radius / r)^n.
Vec<Itrs> GravityField::acceleration_m_per_s2(const Vec<Itrs>& position_m) const {
  const double r = norm(position_m);
  const Vec<Itrs> up = position_m / r;
  const double pull = earth_gm_m3_per_s2 / (r * r);
  if (degree_ == 0) return up * -pull;
  const double ratio = egm2008_radius_m / r, near = ratio * up.z, far = ratio * ratio;
  Sums sums;
  std::array<Orders, 3> of_degree{};  // this one and the two before it
  of_degree[0][0] = 1.0;
  for (int n = 1; n <= degree_; ++n) {
    const auto [first, diagonal] = rows_[std::size_t(n)];
    const Orders &before = of_degree[std::size_t(n + 1) % 3],
                 &last = of_degree[std::size_t(n + 2) % 3];
    Orders& now = of_degree[std::size_t(n) % 3];
    const double *ahead = &ahead_[first], *behind = &behind_[first];
    for (std::size_t m = 0; m < std::size_t(n); ++m)
      now[m] = near * ahead[m] * last[m] - far * behind[m] * before[m];
    now[std::size_t(n)] = ratio * diagonal * last[std::size_t(n) - 1];
    if (n >= 2) add_degree(n, now.data(), &c_[first], &s_[first], &derivative_[first], sums);
  }
  double x = 0, y = 0, z = 0, outwards = 0;
  double cosine = 1, sine = 0, cosine_before = 0, sine_before = 0;  // parts of (up.x + i up.y)^m
  for (int m = 0; m <= degree_; ++m) {
    const std::size_t k = std::size_t(m);
    x += m * (sums.c[k] * cosine_before + sums.s[k] * sine_before);
    y += m * (sums.s[k] * cosine_before - sums.c[k] * sine_before);
    z += sums.derivative_c[k] * cosine + sums.derivative_s[k] * sine;
    outwards += (sums.degree_c[k] + m * sums.c[k]) * cosine;
    outwards += (sums.degree_s[k] + m * sums.s[k]) * sine;
    cosine_before = cosine;
    sine_before = sine;
    cosine = up.x * cosine_before - up.y * sine_before;
    sine = up.x * sine_before + up.y * cosine_before;
  }
  return (Vec<Itrs>{x, y, z} - up * (1 + outwards + up.z * z)) * pull;
}

}  // namespace dmise
