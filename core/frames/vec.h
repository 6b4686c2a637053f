#pragma once
#include <array>
#include <cmath>

namespace dmise {

// Frames. Axes and origins are stated once, here.
struct Gcrs {};         // geocentric celestial (ICRS axes), origin: Earth's centre
struct Itrs {};         // Earth-fixed (IERS), origin: Earth's centre
struct Teme {};         // SGP4's output: true equator, mean equinox of date
struct Enu {};          // east, north, up at a site on the ellipsoid, origin: the site
struct CameraFrame {};  // x along columns (right), y along rows (down), z along the boresight

/// A vector whose components are in frame `F`. Unit in the variable's name.
template <class F>
struct Vec {
  double x = 0.0, y = 0.0, z = 0.0;

  Vec operator+(const Vec& b) const { return {x + b.x, y + b.y, z + b.z}; }
  Vec operator-(const Vec& b) const { return {x - b.x, y - b.y, z - b.z}; }
  Vec operator-() const { return {-x, -y, -z}; }
  Vec operator*(double s) const { return {x * s, y * s, z * s}; }
  Vec operator/(double s) const { return {x / s, y / s, z / s}; }
  Vec& operator+=(const Vec& b) { return *this = *this + b; }
  bool operator==(const Vec&) const = default;
};

template <class F>
Vec<F> operator*(double s, const Vec<F>& v) {
  return v * s;
}
template <class F>
double dot(const Vec<F>& a, const Vec<F>& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
template <class F>
Vec<F> cross(const Vec<F>& a, const Vec<F>& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
template <class F>
double norm(const Vec<F>& v) {
  return std::sqrt(dot(v, v));
}
/// Unit vector along `v`; `v` must not be zero.
template <class F>
Vec<F> unit(const Vec<F>& v) {
  return v / norm(v);
}
/// Angle between two directions [rad, 0..pi], accurate at every angle.
template <class F>
double angle_rad(const Vec<F>& a, const Vec<F>& b) {
  return std::atan2(norm(cross(a, b)), dot(a, b));
}

/// Rotation of axes: `Rotation<To, From> to_from; Vec<To> v = to_from * w` with `Vec<From> w`.
/// Frames cancel side by side; the wrong order does not compile.
template <class To, class From>
struct Rotation {
  // m[i][j]: component i in To of the axis j of From.
  std::array<std::array<double, 3>, 3> m{{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};

  Vec<To> operator*(const Vec<From>& v) const {
    return {m[0][0] * v.x + m[0][1] * v.y + m[0][2] * v.z,
            m[1][0] * v.x + m[1][1] * v.y + m[1][2] * v.z,
            m[2][0] * v.x + m[2][1] * v.y + m[2][2] * v.z};
  }
  template <class Earlier>
  Rotation<To, Earlier> operator*(const Rotation<From, Earlier>& b) const {
    Rotation<To, Earlier> r;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        r.m[i][j] = m[i][0] * b.m[0][j] + m[i][1] * b.m[1][j] + m[i][2] * b.m[2][j];
    return r;
  }
  Rotation<From, To> inverse() const {
    Rotation<From, To> r;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) r.m[i][j] = m[j][i];
    return r;
  }
  bool operator==(const Rotation&) const = default;
};

/// Direction cosines of right ascension and declination (or longitude and latitude) [rad].
template <class F>
Vec<F> from_spherical(double longitude_rad, double latitude_rad) {
  const double c = std::cos(latitude_rad);
  return {std::cos(longitude_rad) * c, std::sin(longitude_rad) * c, std::sin(latitude_rad)};
}
/// Longitude [rad, 0..2pi) and latitude [rad] of a direction; any length > 0.
template <class F>
std::array<double, 2> to_spherical(const Vec<F>& v) {
  double longitude = std::atan2(v.y, v.x);
  if (longitude < 0) longitude += 2 * 3.14159265358979323846;
  return {longitude, std::atan2(v.z, std::hypot(v.x, v.y))};
}

}  // namespace dmise
