#pragma once
#include <cstddef>
#include <cstdint>

#include "core/orbit/elements/elements.h"

// Terms of one element set for SGP4, and the same for blocks of objects.
namespace dmise::sgp4 {

// WGS72, as AIAA 2006-6753 takes it.
inline constexpr double earth_radius_km = 6378.135;
inline constexpr double earth_radius_m = earth_radius_km * 1e3;
inline constexpr double mu_km3_per_s2 = 398600.8;
inline constexpr double j2 = 0.001082616;
inline constexpr double j3 = -0.00000253881;
inline constexpr double j4 = -0.00000165597;
inline constexpr double j3_over_j2 = j3 / j2;
inline constexpr double xke = 0.07436691613317342;  // sqrt(mu) [Earth radii^1.5 / min]
inline constexpr double two_pi = 6.283185307179586476925286766559;

inline constexpr double minutes_per_day = 1440.0;
inline constexpr double resonance_step_min = 720.0;
inline constexpr double sidereal_rate_rad_per_min = 4.37526908801129966e-3;
inline constexpr double longest_span_min = 1e8;

// Sun and Moon: mean motion [rad/min] and eccentricity.
inline constexpr double sun_rate = 1.19459e-5, sun_eccentricity = 0.01675;
inline constexpr double moon_rate = 1.5835218e-4, moon_eccentricity = 0.05490;

/// Objects per block of terms: a multiple of the lanes of every instruction set.
inline constexpr int block_lanes = 16;
struct alignas(64) Lanes {
  double lane[block_lanes];
};

// T is double for one object and Lanes for a block. Times in minutes, angles in radians, lengths in
// Earth radii unless stated.

template <class T>
struct SecularTerms {
  T epoch_jd1, epoch_jd2;
  T m, m_dot;        // mean anomaly; rates hold the Sun's and Moon's share for deep space
  T argp, argp_dot;  // argument of perigee
  T node, node_dot, node_t2;
  T e, e_dot;    // near: e includes B* C5 sin M0
  T a_t;         // semi-major axis / a0 = (1 - a_t t - ...)^2
  T l_t2;        // mean longitude, drag: l_t2 t^2 + ...
  T sqrt_a0;     // square root of the semi-major axis at epoch [Earth radii^1/2]
  T farthest_m;  // 2.2 a (1 + e)
};

template <class T>
struct NearTerms {
  SecularTerms<T> secular;
  T a_t2, a_t3, a_t4, l_t3, l_t4, l_t5;  // drag, higher orders
  T eta, m_cubic, m_cubic0, m_linear;    // shift m_cubic (1 + eta cos M)^3 - m_cubic0 + m_linear t
  T e_sin;                               // B* C5
  T sin_i, cos_i;
  T long_period;  // coefficient of the long-period term in mean longitude
};

// Coefficients of one body's long-period terms: f2 = sin^2/2 - 1/4 and f3 = -sin cos/2 of its
// longitude, and its sine.
template <class T>
struct BodyTerms {
  T phase;  // mean anomaly of the body at epoch
  T e2, e3, i2, i3, l2, l3, l4, gh2, gh3, gh4, h2, h3;
};

template <class T>
struct DeepTerms {
  SecularTerms<T> secular;
  T i, i_dot;
  BodyTerms<T> sun, moon;
};

// Geopotential resonance of orbits of about one day (s...) or half a day (d...).
template <class T>
struct SynchronousTerms {
  T lambda0, n0, drift, gst;  // longitude, mean motion, xfact, Greenwich sidereal time; at epoch
  T del1, del2, del3;
};
template <class T>
struct HalfDayTerms {
  T lambda0, n0, drift, gst;
  T argp, argp_dot;  // without the Sun and Moon
  T d2201, d2211, d3210, d3222, d4410, d4422, d5220, d5232, d5421, d5433;
};

/// The integrator node last reached by a block's lanes, and the slopes there. `time` is a whole
/// number of 720 min from the epoch; NaN if there is none.
struct ResonanceNode {
  Lanes time, lambda, n, n_dot, n_ddot;
};

enum class Resonance : std::uint8_t { none, day, half_day };

/// All terms of one object.
struct Model {
  std::uint8_t code = 0;  // not 0: SGP4 cannot be initialised
  bool deep = false;
  Resonance resonance = Resonance::none;
  double eccentricity = 0.0, inclination_rad = 0.0;
  NearTerms<double> near{};
  DeepTerms<double> far{};
  SynchronousTerms<double> day{};
  HalfDayTerms<double> half_day{};
};

Model initialise(const MeanElements& elements);

// Steps of initialise(), in sgp4_deep_terms.cpp.
struct Recovered {  // Brouwer elements at epoch
  double n, a, sin_i, cos_i, m_dot, argp_dot, node_dot, gst;
};
void add_deep_space(const MeanElements& elements, const Recovered& at_epoch, Model& model);

/// Sets one lane of a block.
template <template <class> class Terms>
void set_lane(Terms<Lanes>& block, int lane, const Terms<double>& one) {
  static_assert(sizeof(Terms<Lanes>) == block_lanes * sizeof(Terms<double>));
  auto* to = reinterpret_cast<Lanes*>(&block);
  const auto* from = reinterpret_cast<const double*>(&one);
  for (std::size_t k = 0; k < sizeof(one) / sizeof(double); ++k) to[k].lane[lane] = from[k];
}
/// Copies one lane of a block to one lane of another.
template <template <class> class Terms>
void copy_lane(Terms<Lanes>& to_block, int to_lane, const Terms<Lanes>& from_block, int lane) {
  auto* to = reinterpret_cast<Lanes*>(&to_block);
  const auto* from = reinterpret_cast<const Lanes*>(&from_block);
  for (std::size_t k = 0; k < sizeof(to_block) / sizeof(Lanes); ++k)
    to[k].lane[to_lane] = from[k].lane[lane];
}

}  // namespace dmise::sgp4
