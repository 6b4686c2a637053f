#pragma once
#include <cmath>

#include "core/base/units.h"
#include "core/forces/forces.h"
#include "core/frames/earth_orientation.h"
#include "core/orbit/two_body.h"

// Accelerations for any type of number: double, and numbers with derivatives.
namespace dmise {

/// Zonal harmonics of EGM2008, unnormalised, tide-free, and their radius [m] (Pavlis et al. 2012).
inline constexpr double earth_j2 = 1.0826261738522e-3;
inline constexpr double earth_j3 = -2.5324105185677e-6;
inline constexpr double earth_j4 = -1.6198975999170e-6;
inline constexpr double earth_zonal_radius_m = 6378136.3;
/// The ellipsoid of heights, and the radius of the shadow [m].
inline constexpr double earth_equatorial_radius_m = 6378137.0;
inline constexpr double earth_flattening = 1 / 298.257223563;
/// Pressure of sunlight on a black plate at 1 au [N/m^2]: 1361 W/m^2 (Kopp & Lean 2011) over c.
inline constexpr double solar_pressure_n_per_m2 = 1361.0 / speed_of_light_m_per_s;
inline constexpr double sun_gm_m3_per_s2 = 1.32712440018e20;  // DE405
inline constexpr double moon_gm_m3_per_s2 = 4.902800066e12;   // DE421

/// A vector of any type of number.
template <class T>
struct Triple {
  T x, y, z;
};

/// The row of the density table (Vallado's table 8-4) for a height above the ellipsoid [m]: rho =
/// density exp(-(height - base) / scale). Below 0 the density is that of 0, above the air 0.
struct AirLayer {
  double base_m = 0.0, density_kg_per_m3 = 0.0, scale_m = 0.0;
};
AirLayer air_layer(double height_m);

inline double value_of(double x) { return x; }
template <class T>
double value_of(const T& x) {
  return x.value();
}

template <class T>
void add_zonals(int highest, const Vec<Gcrs>& pole, const Triple<T>& r, const T& r2, Triple<T>& a) {
  const T z = r.x * pole.x + r.y * pole.y + r.z * pole.z;
  const T i2 = 1.0 / r2;
  const T s2 = z * z * i2;  // sine of the latitude, squared
  const T i5 = i2 * i2 * i2 * sqrt(r2);
  constexpr double k2 =
      -earth_gm_m3_per_s2 * earth_j2 * earth_zonal_radius_m * earth_zonal_radius_m / 2;
  T along = k2 * i5 * (3.0 - 15.0 * s2), polar = k2 * i5 * 6.0 * z;
  if (highest >= 3) {
    constexpr double k3 = -earth_gm_m3_per_s2 * earth_j3 * earth_zonal_radius_m *
                          earth_zonal_radius_m * earth_zonal_radius_m / 2;
    along += k3 * i5 * i2 * z * (15.0 - 35.0 * s2);
    polar += k3 * i5 * (15.0 * s2 - 3.0);
  }
  if (highest >= 4) {
    constexpr double r4 =
        earth_zonal_radius_m * earth_zonal_radius_m * earth_zonal_radius_m * earth_zonal_radius_m;
    constexpr double k4 = -earth_gm_m3_per_s2 * earth_j4 * r4 / 8;
    along += k4 * i5 * i2 * (210.0 * s2 - 315.0 * s2 * s2 - 15.0);
    polar += k4 * i5 * i2 * z * (140.0 * s2 - 60.0);
  }
  a.x += along * r.x + polar * pole.x;
  a.y += along * r.y + polar * pole.y;
  a.z += along * r.z + polar * pole.z;
}

template <class T>
void add_drag(const Vec<Gcrs>& pole, const Triple<T>& r, const Triple<T>& v, const T& r2,
              const T& drag_m2_per_kg, Triple<T>& a) {
  const T distance = sqrt(r2);
  const T z = r.x * pole.x + r.y * pole.y + r.z * pole.z;
  const T height = distance - earth_equatorial_radius_m * (1.0 - earth_flattening * (z * z) / r2);
  const AirLayer air = air_layer(value_of(height));
  if (air.density_kg_per_m3 == 0) return;
  const T density = air.density_kg_per_m3 * exp((air.base_m - height) / air.scale_m);
  const Vec<Gcrs> w = pole * earth_turn_rad_per_s;
  const T x = v.x - (w.y * r.z - w.z * r.y);
  const T y = v.y - (w.z * r.x - w.x * r.z);
  const T u = v.z - (w.x * r.y - w.y * r.x);
  const T factor = -0.5 * density * drag_m2_per_kg * sqrt(x * x + y * y + u * u);
  a.x += factor * x;
  a.y += factor * y;
  a.z += factor * u;
}

/// Pressure of sunlight; none in the cylinder behind the Earth.
template <class T>
void add_radiation(const Vec<Gcrs>& sun_m, const Triple<T>& r, const T& srp_m2_per_kg,
                   Triple<T>& a) {
  const Vec<Gcrs> here{value_of(r.x), value_of(r.y), value_of(r.z)};
  const Vec<Gcrs> towards = unit(sun_m);
  const double along = dot(here, towards);
  if (along < 0 &&
      dot(here, here) - along * along < earth_equatorial_radius_m * earth_equatorial_radius_m)
    return;
  const T x = r.x - sun_m.x, y = r.y - sun_m.y, z = r.z - sun_m.z;
  const T d2 = x * x + y * y + z * z;
  const T factor = solar_pressure_n_per_m2 * au_m * au_m * srp_m2_per_kg / (d2 * sqrt(d2));
  a.x += factor * x;
  a.y += factor * y;
  a.z += factor * z;
}

/// Attraction of a distant point relative to that of the Earth's centre, by Battin's q function.
template <class T>
void add_point(double gm, const Vec<Gcrs>& body_m, const Triple<T>& r, const T& r2, Triple<T>& a) {
  const double b2 = dot(body_m, body_m);
  const T q = (r2 - 2.0 * (r.x * body_m.x + r.y * body_m.y + r.z * body_m.z)) / b2;
  const T root = sqrt(1.0 + q);
  const T f = q * (3.0 + 3.0 * q + q * q) / (1.0 + root * root * root);
  const T x = r.x - body_m.x, y = r.y - body_m.y, z = r.z - body_m.z;
  const T d2 = x * x + y * y + z * z;
  const T factor = -gm / (d2 * sqrt(d2));
  a.x += factor * (r.x + f * body_m.x);
  a.y += factor * (r.y + f * body_m.y);
  a.z += factor * (r.z + f * body_m.z);
}

/// Sum of the accelerations by the forces of `settings` [m/s^2].
template <class T>
Triple<T> acceleration(const ForceSettings& settings, const ForceInputs& around, const Triple<T>& r,
                       const Triple<T>& v, const T& drag_m2_per_kg, const T& srp_m2_per_kg) {
  const T r2 = r.x * r.x + r.y * r.y + r.z * r.z;
  const T factor = -earth_gm_m3_per_s2 / (r2 * sqrt(r2));
  Triple<T> a{factor * r.x, factor * r.y, factor * r.z};
  if (settings.zonals >= 2) add_zonals(settings.zonals, around.pole, r, r2, a);
  if (settings.drag) add_drag(around.pole, r, v, r2, drag_m2_per_kg, a);
  if (settings.radiation) add_radiation(around.sun_m, r, srp_m2_per_kg, a);
  if (settings.sun_moon) {
    add_point(sun_gm_m3_per_s2, around.sun_m, r, r2, a);
    add_point(moon_gm_m3_per_s2, around.moon_m, r, r2, a);
  }
  return a;
}

}  // namespace dmise
