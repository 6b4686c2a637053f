#pragma once

namespace dmise {

// Motion on a conic as a function of the universal anomaly `s`, counted from the periapsis, in
// units where mu = 1 (time carries sqrt(mu)). One formulation covers all conics, without
// cancellation near e = 1. Extended precision, because the phase after 1e5 orbits uses up most
// digits of a double. Source: Battin, An Introduction to the Mathematics and Methods of
// Astrodynamics, section 4.5.

/// U0 to U3: s^k / k! (1 - alpha s^2 / ((k+1)(k+2)) + ...).
struct UniversalFunctions {
  long double u0, u1, u2, u3;
};

UniversalFunctions universal_functions(long double s, long double alpha);

/// A conic: `alpha` = 1 / semi-major axis (> 0 ellipse, 0 parabola, < 0 hyperbola), periapsis
/// distance `q` >= 0, eccentricity `e` >= 0, with alpha q = 1 - e.
struct Conic {
  long double alpha, q, e;
};

/// Root s of  q s + e U3(s) = time, `time` from the periapsis; within half a period of it on an
/// ellipse. Never fails: the left side grows monotonously.
long double universal_anomaly(const Conic& conic, long double time);

}  // namespace dmise
