#include <cmath>

#include "core/orbit/sgp4/sgp4_terms.h"

// Lunar, solar and resonant terms: Hujsak, Spacetrack Report 3 (1980) and AIAA 2006-6753.
namespace dmise::sgp4 {
namespace {

/// Orientation of a perturbing body's orbit relative to the satellite's node, and its strength.
struct Body {
  double sin_g, cos_g, sin_i, cos_i, sin_h, cos_h;
  double strength, rate, eccentricity;
};

/// Rates of the mean elements caused by one body [rad/min].
struct BodyRates {
  double e, i, m, gh, h;
};

BodyRates body_terms(const Body& b, const MeanElements& el, double n, double sin_i, double cos_i,
                     BodyTerms<double>& out) {
  const double sin_w = std::sin(el.argument_of_perigee_rad);
  const double cos_w = std::cos(el.argument_of_perigee_rad);
  const double e = el.eccentricity;
  const double e2 = e * e;
  const double beta2 = 1.0 - e2;
  const double beta = std::sqrt(beta2);

  const double a1 = b.cos_g * b.cos_h + b.sin_g * b.cos_i * b.sin_h;
  const double a3 = -b.sin_g * b.cos_h + b.cos_g * b.cos_i * b.sin_h;
  const double a7 = -b.cos_g * b.sin_h + b.sin_g * b.cos_i * b.cos_h;
  const double a8 = b.sin_g * b.sin_i;
  const double a9 = b.sin_g * b.sin_h + b.cos_g * b.cos_i * b.cos_h;
  const double a10 = b.cos_g * b.sin_i;
  const double a2 = cos_i * a7 + sin_i * a8;
  const double a4 = cos_i * a9 + sin_i * a10;
  const double a5 = -sin_i * a7 + cos_i * a8;
  const double a6 = -sin_i * a9 + cos_i * a10;
  const double x1 = a1 * cos_w + a2 * sin_w;
  const double x2 = a3 * cos_w + a4 * sin_w;
  const double x3 = -a1 * sin_w + a2 * cos_w;
  const double x4 = -a3 * sin_w + a4 * cos_w;
  const double x5 = a5 * sin_w;
  const double x6 = a6 * sin_w;
  const double x7 = a5 * cos_w;
  const double x8 = a6 * cos_w;

  const double z31 = 12.0 * x1 * x1 - 3.0 * x3 * x3;
  const double z32 = 24.0 * x1 * x2 - 6.0 * x3 * x4;
  const double z33 = 12.0 * x2 * x2 - 3.0 * x4 * x4;
  const double z1 = 2.0 * (3.0 * (a1 * a1 + a2 * a2) + z31 * e2) + beta2 * z31;
  const double z2 = 2.0 * (6.0 * (a1 * a3 + a2 * a4) + z32 * e2) + beta2 * z32;
  const double z3 = 2.0 * (3.0 * (a3 * a3 + a4 * a4) + z33 * e2) + beta2 * z33;
  const double z11 = -6.0 * a1 * a5 + e2 * (-24.0 * x1 * x7 - 6.0 * x3 * x5);
  const double z12 =
      -6.0 * (a1 * a6 + a3 * a5) + e2 * (-24.0 * (x2 * x7 + x1 * x8) - 6.0 * (x3 * x6 + x4 * x5));
  const double z13 = -6.0 * a3 * a6 + e2 * (-24.0 * x2 * x8 - 6.0 * x4 * x6);
  const double z21 = 6.0 * a2 * a5 + e2 * (24.0 * x1 * x5 - 6.0 * x3 * x7);
  const double z22 =
      6.0 * (a4 * a5 + a2 * a6) + e2 * (24.0 * (x2 * x5 + x1 * x6) - 6.0 * (x4 * x7 + x3 * x8));
  const double z23 = 6.0 * a4 * a6 + e2 * (24.0 * x2 * x6 - 6.0 * x4 * x8);

  const double s3 = b.strength / n;
  const double s2 = -0.5 * s3 / beta;
  const double s4 = s3 * beta;
  const double s1 = -15.0 * e * s4;
  const double s5 = x1 * x3 + x2 * x4;
  const double s6 = x2 * x3 + x1 * x4;
  const double s7 = x2 * x4 - x1 * x3;

  out.e2 = 2.0 * s1 * s6;
  out.e3 = 2.0 * s1 * s7;
  out.i2 = 2.0 * s2 * z12;
  out.i3 = 2.0 * s2 * (z13 - z11);
  out.l2 = -2.0 * s3 * z2;
  out.l3 = -2.0 * s3 * (z3 - z1);
  out.l4 = -2.0 * s3 * (-21.0 - 9.0 * e2) * b.eccentricity;
  out.gh2 = 2.0 * s4 * z32;
  out.gh3 = 2.0 * s4 * (z33 - z31);
  out.gh4 = -18.0 * s4 * b.eccentricity;
  out.h2 = -2.0 * s2 * z22;
  out.h3 = -2.0 * s2 * (z23 - z21);

  // Within 3 deg of the equator the node's rate is omitted.
  constexpr double near_equator = 5.2359877e-2;
  const bool flat =
      el.inclination_rad < near_equator || el.inclination_rad > two_pi / 2.0 - near_equator;
  BodyRates rates;
  rates.e = s1 * b.rate * s5;
  rates.i = s2 * b.rate * (z11 + z13);
  rates.m = -b.rate * s3 * (z1 + z3 - 14.0 - 6.0 * e2);
  rates.h = flat || sin_i == 0.0 ? 0.0 : -b.rate * s2 * (z21 + z23) / sin_i;
  rates.gh = s4 * b.rate * (z31 + z33 - 6.0) - cos_i * rates.h;
  return rates;
}

double polynomial(double x, double c0, double c1, double c2, double c3) {
  return c0 + c1 * x + c2 * (x * x) + c3 * (x * (x * x));
}

void half_day_terms(double e, double n, double a_inv, double sin_i, double cos_i,
                    HalfDayTerms<double>& out) {
  // Eccentricity functions.
  const double g201 = -0.306 - (e - 0.64) * 0.440;
  double g211, g310, g322, g410, g422, g520;
  if (e <= 0.65) {
    g211 = polynomial(e, 3.616, -13.2470, 16.2900, 0.0);
    g310 = polynomial(e, -19.302, 117.3900, -228.4190, 156.5910);
    g322 = polynomial(e, -18.9068, 109.7927, -214.6334, 146.5816);
    g410 = polynomial(e, -41.122, 242.6940, -471.0940, 313.9530);
    g422 = polynomial(e, -146.407, 841.8800, -1629.014, 1083.4350);
    g520 = polynomial(e, -532.114, 3017.977, -5740.032, 3708.2760);
  } else {
    g211 = polynomial(e, -72.099, 331.819, -508.738, 266.724);
    g310 = polynomial(e, -346.844, 1582.851, -2415.925, 1246.113);
    g322 = polynomial(e, -342.585, 1554.908, -2366.899, 1215.972);
    g410 = polynomial(e, -1052.797, 4758.686, -7193.992, 3651.957);
    g422 = polynomial(e, -3581.690, 16178.110, -24462.770, 12422.520);
    g520 = e > 0.715 ? polynomial(e, -5149.66, 29936.92, -54087.36, 31324.56)
                     : polynomial(e, 1464.74, -4664.75, 3763.64, 0.0);
  }
  double g521, g532, g533;
  if (e < 0.7) {
    g533 = polynomial(e, -919.22770, 4988.6100, -9064.7700, 5542.21);
    g521 = polynomial(e, -822.71072, 4568.6173, -8491.4146, 5337.524);
    g532 = polynomial(e, -853.66600, 4690.2500, -8624.7700, 5341.4);
  } else {
    g533 = polynomial(e, -37995.780, 161616.52, -229838.20, 109377.94);
    g521 = polynomial(e, -51752.104, 218913.95, -309468.16, 146349.42);
    g532 = polynomial(e, -40023.880, 170470.89, -242699.48, 115605.82);
  }
  // Inclination functions.
  const double c = cos_i, c2 = cos_i * cos_i, s = sin_i, s2 = sin_i * sin_i;
  const double f220 = 0.75 * (1.0 + 2.0 * c + c2);
  const double f221 = 1.5 * s2;
  const double f321 = 1.875 * s * (1.0 - 2.0 * c - 3.0 * c2);
  const double f322 = -1.875 * s * (1.0 + 2.0 * c - 3.0 * c2);
  const double f441 = 35.0 * s2 * f220;
  const double f442 = 39.3750 * s2 * s2;
  const double f522 =
      9.84375 * s * (s2 * (1.0 - 2.0 * c - 5.0 * c2) + 0.33333333 * (-2.0 + 4.0 * c + 6.0 * c2));
  const double f523 = s * (4.92187512 * s2 * (-2.0 - 4.0 * c + 10.0 * c2) +
                           6.56250012 * (1.0 + 2.0 * c - 3.0 * c2));
  const double f542 = 29.53125 * s * (2.0 - 8.0 * c + c2 * (-12.0 + 8.0 * c + 10.0 * c2));
  const double f543 = 29.53125 * s * (-2.0 - 8.0 * c + c2 * (12.0 + 8.0 * c - 10.0 * c2));
  // Geopotential coefficients.
  constexpr double root22 = 1.7891679e-6, root32 = 3.7393792e-7, root44 = 7.3636953e-9,
                   root52 = 1.1428639e-7, root54 = 2.1765803e-9;
  double k = 3.0 * n * n * a_inv * a_inv;
  out.d2201 = k * root22 * f220 * g201;
  out.d2211 = k * root22 * f221 * g211;
  k *= a_inv;
  out.d3210 = k * root32 * f321 * g310;
  out.d3222 = k * root32 * f322 * g322;
  k *= a_inv;
  out.d4410 = 2.0 * k * root44 * f441 * g410;
  out.d4422 = 2.0 * k * root44 * f442 * g422;
  k *= a_inv;
  out.d5220 = k * root52 * f522 * g520;
  out.d5232 = k * root52 * f523 * g532;
  out.d5421 = 2.0 * k * root54 * f542 * g521;
  out.d5433 = 2.0 * k * root54 * f543 * g533;
}

}  // namespace

void add_deep_space(const MeanElements& el, const Recovered& at, Model& model) {
  const double days = el.epoch_jd1 + el.epoch_jd2 - 2433281.5;
  const double day = days + 18261.5;  // since 1900 January 0.5
  const double sin_node = std::sin(el.raan_rad);
  const double cos_node = std::cos(el.raan_rad);
  DeepTerms<double>& far = model.far;

  Body sun;
  sun.sin_g = -0.98088458;
  sun.cos_g = 0.1945905;
  sun.sin_i = 0.39785416;
  sun.cos_i = 0.91744867;
  sun.sin_h = sin_node;
  sun.cos_h = cos_node;
  sun.strength = 2.9864797e-6;
  sun.rate = sun_rate;
  sun.eccentricity = sun_eccentricity;

  // The Moon's orbit, from its node on the ecliptic.
  const double moon_node = std::fmod(4.5236020 - 9.2422029e-4 * day, two_pi);
  const double sin_mn = std::sin(moon_node);
  const double cos_mn = std::cos(moon_node);
  Body moon;
  moon.cos_i = 0.91375164 - 0.03568096 * cos_mn;
  moon.sin_i = std::sqrt(1.0 - moon.cos_i * moon.cos_i);
  const double sin_h = 0.089683511 * sin_mn / moon.sin_i;
  const double cos_h = std::sqrt(1.0 - sin_h * sin_h);
  const double moon_perigee = 5.8351514 + 0.0019443680 * day;
  const double g =
      moon_perigee +
      std::atan2(0.39785416 * sin_mn / moon.sin_i, cos_h * cos_mn + 0.91744867 * sin_h * sin_mn) -
      moon_node;
  moon.sin_g = std::sin(g);
  moon.cos_g = std::cos(g);
  moon.sin_h = sin_node * cos_h - cos_node * sin_h;
  moon.cos_h = cos_h * cos_node + sin_h * sin_node;
  moon.strength = 4.7968065e-7;
  moon.rate = moon_rate;
  moon.eccentricity = moon_eccentricity;

  const BodyRates s = body_terms(sun, el, at.n, at.sin_i, at.cos_i, far.sun);
  const BodyRates l = body_terms(moon, el, at.n, at.sin_i, at.cos_i, far.moon);
  far.sun.phase = std::fmod(6.2565837 + 0.017201977 * day, two_pi);
  far.moon.phase = std::fmod(4.7199672 + 0.22997150 * day - moon_perigee, two_pi);

  const double e_dot = s.e + l.e;
  const double m_dot = s.m + l.m;
  const double argp_dot = s.gh + l.gh;
  const double node_dot = s.h + l.h;
  far.i = el.inclination_rad;
  far.i_dot = s.i + l.i;
  far.secular.e_dot += e_dot;
  far.secular.m_dot += m_dot;
  far.secular.argp_dot += argp_dot;
  far.secular.node_dot += node_dot;

  const double e = el.eccentricity;
  const double a_inv = std::pow(at.n / xke, 2.0 / 3.0);
  if (at.n > 0.0034906585 && at.n < 0.0052359877) {
    model.resonance = Resonance::day;
    SynchronousTerms<double>& day_terms = model.day;
    constexpr double q22 = 1.7891679e-6, q31 = 2.1460748e-6, q33 = 2.2123015e-7;
    const double e2 = e * e;
    const double g200 = 1.0 + e2 * (-2.5 + 0.8125 * e2);
    const double g310 = 1.0 + 2.0 * e2;
    const double g300 = 1.0 + e2 * (-6.0 + 6.60937 * e2);
    const double c1 = 1.0 + at.cos_i;
    const double f220 = 0.75 * c1 * c1;
    const double f311 = 0.9375 * at.sin_i * at.sin_i * (1.0 + 3.0 * at.cos_i) - 0.75 * c1;
    const double f330 = 1.875 * c1 * c1 * c1;
    const double k = 3.0 * at.n * at.n * a_inv * a_inv;
    day_terms.del1 = k * f311 * g310 * q31 * a_inv;
    day_terms.del2 = 2.0 * k * f220 * g200 * q22;
    day_terms.del3 = 3.0 * k * f330 * g300 * q33 * a_inv;
    day_terms.lambda0 =
        std::fmod(el.mean_anomaly_rad + el.raan_rad + el.argument_of_perigee_rad - at.gst, two_pi);
    day_terms.drift = at.m_dot + (at.argp_dot + at.node_dot) - sidereal_rate_rad_per_min + m_dot +
                      argp_dot + node_dot - at.n;
    day_terms.n0 = at.n;
    day_terms.gst = at.gst;
  } else if (at.n >= 8.26e-3 && at.n <= 9.24e-3 && e >= 0.5) {
    model.resonance = Resonance::half_day;
    HalfDayTerms<double>& half = model.half_day;
    half_day_terms(e, at.n, a_inv, at.sin_i, at.cos_i, half);
    half.lambda0 = std::fmod(el.mean_anomaly_rad + 2.0 * el.raan_rad - 2.0 * at.gst, two_pi);
    half.drift =
        at.m_dot + m_dot + 2.0 * (at.node_dot + node_dot - sidereal_rate_rad_per_min) - at.n;
    half.n0 = at.n;
    half.gst = at.gst;
    half.argp = el.argument_of_perigee_rad;
    half.argp_dot = at.argp_dot;
  }
}

}  // namespace dmise::sgp4
