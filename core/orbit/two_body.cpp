#include "core/orbit/two_body.h"

#include <cmath>
#include <numbers>
#include <string>

#include "core/base/error.h"
#include "core/orbit/universal_kepler.h"

namespace dmise {

namespace {

/// A vector in extended precision.
struct Long3 {
  long double x, y, z;
  Long3 operator*(long double s) const { return {x * s, y * s, z * s}; }
  Long3 operator+(const Long3& b) const { return {x + b.x, y + b.y, z + b.z}; }
  Long3 operator-(const Long3& b) const { return {x - b.x, y - b.y, z - b.z}; }
};

Long3 widened(const Vec<Gcrs>& v) { return {v.x, v.y, v.z}; }
Vec<Gcrs> rounded(const Long3& v) {
  return {static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z)};
}
long double dot(const Long3& a, const Long3& b) { return a.x * b.x + a.y * b.y + a.z * b.z; }
Long3 cross(const Long3& a, const Long3& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
bool finite(const Vec<Gcrs>& v) {
  return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

/// Universal anomaly of a state from its  e U1 = sigma  and  e U0 = 1 - alpha r.
long double anomaly_of(const Conic& conic, long double sigma, long double e_u0) {
  if (conic.alpha > 0) {
    const long double root = std::sqrt(conic.alpha);
    return std::atan2(sigma * root, e_u0) / root;
  }
  if (conic.alpha < 0) {
    const long double root = std::sqrt(-conic.alpha);
    return std::asinh(sigma * root / conic.e) / root;
  }
  return sigma / conic.e;
}

}  // namespace

TwoBodyState state_of(const KeplerElements& k, double gm_m3_per_s2) {
  const auto refuse = [](const char* reason, double value) {
    throw Error(std::string("two_body: ") + reason + ", got " + std::to_string(value));
  };
  if (!(k.periapsis_m > 0 && std::isfinite(k.periapsis_m)))
    refuse("periapsis_m must be > 0", k.periapsis_m);
  if (!(k.eccentricity >= 0 && std::isfinite(k.eccentricity)))
    refuse("eccentricity must be >= 0", k.eccentricity);
  const double p_m = k.periapsis_m * (1 + k.eccentricity);
  const double shape = 1 + k.eccentricity * std::cos(k.true_anomaly_rad);
  if (!(shape > 0)) refuse("true_anomaly_rad must be inside the asymptotes", k.true_anomaly_rad);
  const double co = std::cos(k.raan_rad), so = std::sin(k.raan_rad);
  const double ci = std::cos(k.inclination_rad), si = std::sin(k.inclination_rad);
  const double cw = std::cos(k.argument_of_perigee_rad), sw = std::sin(k.argument_of_perigee_rad);
  const Vec<Gcrs> to_periapsis{co * cw - so * sw * ci, so * cw + co * sw * ci, sw * si};
  const Vec<Gcrs> across{-co * sw - so * cw * ci, -so * sw + co * cw * ci, cw * si};
  const double cv = std::cos(k.true_anomaly_rad), sv = std::sin(k.true_anomaly_rad);
  const double speed = std::sqrt(gm_m3_per_s2 / p_m);
  return {(to_periapsis * cv + across * sv) * (p_m / shape),
          (to_periapsis * -sv + across * (k.eccentricity + cv)) * speed};
}

TwoBodyState propagate_two_body(const TwoBodyState& start, double dt_s, double gm_m3_per_s2) {
  if (!finite(start.position_m) || !finite(start.velocity_m_per_s) || !std::isfinite(dt_s))
    throw Error("two_body: state and time must be finite");
  if (!(gm_m3_per_s2 > 0)) throw Error("two_body: gm must be > 0");
  const long double root_gm = std::sqrt(static_cast<long double>(gm_m3_per_s2));
  const Long3 r = widened(start.position_m);
  const Long3 w = widened(start.velocity_m_per_s) * (1 / root_gm);  // velocity in units of gm = 1
  const long double r0 = std::sqrt(dot(r, r));
  if (r0 == 0) throw Error("two_body: the state is at the Earth's centre");
  const Long3 h = cross(r, w);
  const long double p = dot(h, h);
  const long double sigma = dot(r, w);

  Conic conic{};
  conic.alpha = 2 / r0 - dot(w, w);
  const long double e_u0 = 1 - conic.alpha * r0;
  conic.e = conic.alpha > 0 ? std::hypot(e_u0, sigma * std::sqrt(conic.alpha))
                            : std::sqrt(1 - conic.alpha * p);
  conic.q = p / (1 + conic.e);

  // Axes of the conic. The periapsis direction is chosen so that the start is met exactly, even if
  // a near-circular orbit defines it poorly.
  const long double s0 = anomaly_of(conic, sigma, e_u0);
  const UniversalFunctions u0 = universal_functions(s0, conic.alpha);
  const long double root_p = std::sqrt(p);
  const Long3 radial = r * (1 / r0);
  const Long3 transverse = p > 0 ? cross(h, radial) * (1 / root_p) : Long3{0, 0, 0};
  long double cosine = conic.q - u0.u2, sine = root_p * u0.u1;
  const long double length = std::hypot(cosine, sine);
  cosine = length > 0 ? cosine / length : 1;
  sine = length > 0 ? sine / length : 0;
  const Long3 x_axis = radial * cosine - transverse * sine;
  const Long3 y_axis = radial * sine + transverse * cosine;

  long double time = conic.q * s0 + conic.e * u0.u3 + root_gm * static_cast<long double>(dt_s);
  if (conic.alpha > 0) {
    const long double period =
        2 * std::numbers::pi_v<long double> / (conic.alpha * std::sqrt(conic.alpha));
    time = std::remainder(time, period);
  }
  const UniversalFunctions u = universal_functions(universal_anomaly(conic, time), conic.alpha);
  const long double radius = conic.q + conic.e * u.u2;
  if (!(radius > 0)) throw Error("two_body: the object is at the Earth's centre");
  return {rounded(x_axis * (conic.q - u.u2) + y_axis * (root_p * u.u1)),
          rounded((x_axis * -u.u1 + y_axis * (root_p * u.u0)) * (root_gm / radius))};
}

}  // namespace dmise
