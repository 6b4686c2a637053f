#pragma once
#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/error.h"
#include "core/frames/vec.h"

namespace dmise {

/// Unit quaternion of a rotation of axes, scalar first: v_to = q v_from q*. The variable's name
/// says which frames it relates.
struct Quaternion {
  double w = 1.0, x = 0.0, y = 0.0, z = 0.0;

  bool operator==(const Quaternion&) const = default;
};

inline Quaternion conjugate(const Quaternion& q) { return {q.w, -q.x, -q.y, -q.z}; }

/// The rotation of `b`, then of `a`: `c_from_a = c_from_b * b_from_a`.
inline Quaternion operator*(const Quaternion& a, const Quaternion& b) {
  return {
      a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z, a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y,
      a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x, a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w};
}

/// Shepperd's method: the largest of the four components is found first, so nothing cancels.
template <class To, class From>
Quaternion quaternion_of(const Rotation<To, From>& rotation) {
  const auto& m = rotation.m;
  const double trace = m[0][0] + m[1][1] + m[2][2];
  const std::array<double, 4> squares = {1 + trace, 1 + 2 * m[0][0] - trace,
                                         1 + 2 * m[1][1] - trace, 1 + 2 * m[2][2] - trace};
  const auto largest = std::max_element(squares.begin(), squares.end()) - squares.begin();
  const double s = 0.5 / std::sqrt(squares[std::size_t(largest)]);
  const double big = 0.5 * std::sqrt(squares[std::size_t(largest)]);
  switch (largest) {
    case 0:
      return {big, (m[2][1] - m[1][2]) * s, (m[0][2] - m[2][0]) * s, (m[1][0] - m[0][1]) * s};
    case 1:
      return {(m[2][1] - m[1][2]) * s, big, (m[1][0] + m[0][1]) * s, (m[0][2] + m[2][0]) * s};
    case 2:
      return {(m[0][2] - m[2][0]) * s, (m[1][0] + m[0][1]) * s, big, (m[2][1] + m[1][2]) * s};
    default:
      return {(m[1][0] - m[0][1]) * s, (m[0][2] + m[2][0]) * s, (m[2][1] + m[1][2]) * s, big};
  }
}

/// `q` is normalised first. Throws `Error` if its length is zero.
template <class To, class From>
Rotation<To, From> rotation_of(const Quaternion& q) {
  const double n = 1.0 / std::sqrt(q.w * q.w + q.x * q.x + q.y * q.y + q.z * q.z);
  if (!std::isfinite(n)) throw Error("a quaternion of length zero is no rotation");
  const double w = q.w * n, x = q.x * n, y = q.y * n, z = q.z * n;
  Rotation<To, From> r;
  r.m = {{{1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)},
          {2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)},
          {2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)}}};
  return r;
}

}  // namespace dmise
