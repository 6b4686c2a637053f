#include "core/orbit/sgp4/sgp4_terms.h"

#include <cmath>

#include "core/orbit/elements/epoch.h"

// Equations: Hoots & Roehrich, Spacetrack Report 3 (1980), as revised by Vallado, Crawford, Hujsak
// & Kelso, AIAA 2006-6753. Products and sums keep the paper's order: with strong drag the longitude
// is quadratic in time with a factor of 1e4 and more, so that the last bit of a term becomes 1e-7
// km after a week.
namespace dmise::sgp4 {
namespace {

double cube(double x) { return x * x * x; }
double fourth(double x) { return x * x * x * x; }

/// Greenwich mean sidereal time, IAU 1982 [rad, 0..2 pi), as AIAA 2006-6753 evaluates it: the epoch
/// is rounded to one double (up to 20 us, 1.5e-9 rad, relevant only to resonant orbits), as in the
/// published implementation.
double sidereal_time(const MeanElements& e) {
  const double days = e.epoch_jd1 + e.epoch_jd2 - 2433281.5;
  const double t = (days + 2433281.5 - 2451545.0) / 36525.0;
  const double seconds =
      -6.2e-6 * t * t * t + 0.093104 * t * t + (876600.0 * 3600 + 8640184.812866) * t + 67310.54841;
  const double angle = std::fmod(seconds * (two_pi / 360.0) / 240.0, two_pi);
  return angle < 0.0 ? angle + two_pi : angle;
}

}  // namespace

Model initialise(const MeanElements& el) {
  Model model;
  const double e = el.eccentricity;
  const double values[] = {el.epoch_jd1,
                           el.epoch_jd2,
                           el.mean_motion_rad_per_min,
                           e,
                           el.inclination_rad,
                           el.raan_rad,
                           el.argument_of_perigee_rad,
                           el.mean_anomaly_rad,
                           el.bstar_per_earth_radius};
  for (double v : values)
    if (!std::isfinite(v)) model.code = 7;
  if (model.code == 0 && !(el.mean_motion_rad_per_min > 0.0)) model.code = 2;
  if (model.code == 0 && !(e >= -0.001 && e < 1.0)) model.code = 1;
  if (model.code != 0) return model;

  const double e2 = e * e;
  const double beta2 = 1.0 - e2;
  const double beta = std::sqrt(beta2);
  const double cos_i = std::cos(el.inclination_rad);
  const double sin_i = std::sin(el.inclination_rad);
  const double cos2_i = cos_i * cos_i;
  const double cos4_i = cos2_i * cos2_i;
  const double con42 = 1.0 - 5.0 * cos2_i;
  const double con41 = -con42 - cos2_i - cos2_i;
  const double x1mth2 = 1.0 - cos2_i;

  // Kozai's mean motion to Brouwer's.
  const double kozai_a = std::pow(xke / el.mean_motion_rad_per_min, 2.0 / 3.0);
  const double d1 = 0.75 * j2 * (3.0 * cos2_i - 1.0) / (beta * beta2);
  double del = d1 / (kozai_a * kozai_a);
  const double a1 = kozai_a * (1.0 - del * del - del * (1.0 / 3.0 + 134.0 * del * del / 81.0));
  del = d1 / (a1 * a1);
  const double n = el.mean_motion_rad_per_min / (1.0 + del);
  const double a = std::pow(xke / n, 2.0 / 3.0);
  if (!(n > 0.0)) {
    model.code = 2;
    return model;
  }

  // Atmosphere: the parameters of the density function depend on the perigee.
  const double perigee = a * (1.0 - e);
  const double perigee_km = (perigee - 1.0) * earth_radius_km;
  double s_km = 78.0;
  if (perigee_km < 156.0) s_km = perigee_km < 98.0 ? 20.0 : perigee_km - 78.0;
  const double s = s_km / earth_radius_km + 1.0;
  const double qs4 = fourth((120.0 - s_km) / earth_radius_km);
  const double tsi = 1.0 / (a - s);
  const double eta = a * e * tsi;
  const double eta2 = eta * eta;
  const double e_eta = e * eta;
  const double psi2 = std::fabs(1.0 - eta2);
  const double coef = qs4 * std::pow(tsi, 4.0);
  const double coef1 = coef / std::pow(psi2, 3.5);
  const double bstar = el.bstar_per_earth_radius;
  const double cos_argp = std::cos(el.argument_of_perigee_rad);
  const double c2 = coef1 * n *
                    (a * (1.0 + 1.5 * eta2 + e_eta * (4.0 + eta2)) +
                     0.375 * j2 * tsi / psi2 * con41 * (8.0 + 3.0 * eta2 * (8.0 + eta2)));
  const double c1 = bstar * c2;
  const bool tiny_e = e <= 1e-4;
  const double c3 = tiny_e ? 0.0 : -2.0 * coef * tsi * j3_over_j2 * n * sin_i / e;
  const double c4 = 2.0 * n * coef1 * a * beta2 *
                    (eta * (2.0 + 0.5 * eta2) + e * (0.5 + 2.0 * eta2) -
                     j2 * tsi / (a * psi2) *
                         (-3.0 * con41 * (1.0 - 2.0 * e_eta + eta2 * (1.5 - 0.5 * e_eta)) +
                          0.75 * x1mth2 * (2.0 * eta2 - e_eta * (1.0 + eta2)) *
                              std::cos(2.0 * el.argument_of_perigee_rad)));
  const double c5 = 2.0 * coef1 * a * beta2 * (1.0 + 2.75 * (eta2 + e_eta) + e_eta * eta2);

  // Secular rates.
  const double inv_p2 = 1.0 / ((a * beta2) * (a * beta2));
  const double k1 = 1.5 * j2 * inv_p2 * n;
  const double k2 = 0.5 * k1 * j2 * inv_p2;
  const double k3 = -0.46875 * j4 * inv_p2 * inv_p2 * n;
  const double m_dot =
      n + 0.5 * k1 * beta * con41 + 0.0625 * k2 * beta * (13.0 - 78.0 * cos2_i + 137.0 * cos4_i);
  const double argp_dot = -0.5 * k1 * con42 +
                          0.0625 * k2 * (7.0 - 114.0 * cos2_i + 395.0 * cos4_i) +
                          k3 * (3.0 - 36.0 * cos2_i + 49.0 * cos4_i);
  const double node_dot_j2 = -k1 * cos_i;
  const double node_dot =
      node_dot_j2 + (0.5 * k2 * (4.0 - 19.0 * cos2_i) + 2.0 * k3 * (3.0 - 7.0 * cos2_i)) * cos_i;

  SecularTerms<double> sec{};
  const ElapsedDate epoch = elapsed_date({el.epoch_jd1, el.epoch_jd2});
  sec.epoch_jd1 = epoch.jd1;
  sec.epoch_jd2 = epoch.jd2;
  sec.m = el.mean_anomaly_rad;
  sec.m_dot = m_dot;
  sec.argp = el.argument_of_perigee_rad;
  sec.argp_dot = argp_dot;
  sec.node = el.raan_rad;
  sec.node_dot = node_dot;
  sec.node_t2 = 3.5 * beta2 * node_dot_j2 * c1;
  sec.e = e;
  sec.e_dot = -bstar * c4;
  sec.a_t = c1;
  sec.l_t2 = n * 1.5 * c1;
  sec.sqrt_a0 = std::sqrt(a);
  sec.farthest_m = 2.2 * a * earth_radius_m * (1.0 + e);
  model.eccentricity = e;
  model.inclination_rad = el.inclination_rad;

  if (two_pi / n >= 225.0) {
    model.deep = true;
    model.far.secular = sec;
    add_deep_space(el, {n, a, sin_i, cos_i, m_dot, argp_dot, node_dot, sidereal_time(el)}, model);
    return model;
  }

  NearTerms<double>& near = model.near;
  near.secular = sec;
  near.eta = eta;
  near.sin_i = sin_i;
  near.cos_i = cos_i;
  near.long_period = -0.25 * j3_over_j2 * sin_i * (3.0 + 5.0 * cos_i) /
                     (std::fabs(cos_i + 1.0) > 1.5e-12 ? 1.0 + cos_i : 1.5e-12);
  if (perigee >= 220.0 / earth_radius_km + 1.0) {  // below it, drag stops at these orders
    const double c1_2 = c1 * c1;
    const double d2 = 4.0 * a * tsi * c1_2;
    const double k = d2 * tsi * c1 / 3.0;
    const double d3 = (17.0 * a + s) * k;
    const double d4 = 0.5 * k * a * tsi * (221.0 * a + 31.0 * s) * c1;
    near.a_t2 = d2;
    near.a_t3 = d3;
    near.a_t4 = d4;
    near.l_t3 = n * (d2 + 2.0 * c1_2);
    near.l_t4 = n * 0.25 * (3.0 * d3 + c1 * (12.0 * d2 + 10.0 * c1_2));
    near.l_t5 =
        n * 0.2 * (3.0 * d4 + 12.0 * c1 * d3 + 6.0 * d2 * d2 + 15.0 * c1_2 * (2.0 * d2 + c1_2));
    near.m_linear = bstar * c3 * cos_argp;
    near.m_cubic = tiny_e ? 0.0 : -2.0 / 3.0 * coef * bstar / e_eta;
    near.m_cubic0 = near.m_cubic * cube(1.0 + eta * std::cos(el.mean_anomaly_rad));
    near.e_sin = bstar * c5;
    near.secular.e += near.e_sin * std::sin(el.mean_anomaly_rad);
  }
  return model;
}

}  // namespace dmise::sgp4
