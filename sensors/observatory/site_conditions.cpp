#include "sensors/observatory/site_conditions.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/frames/geodesy.h"
#include "core/sky/surface_brightness.h"

namespace dmise {
namespace {

constexpr double seeing_wavelength_m = 0.5e-6;
constexpr int rings = 8, around = 12;  // directions over which the sky is averaged

/// Calls `look` with directions of equal shares of the sky above an elevation, as sin(elevation)
/// is even, or of the light on level ground, as its square is.
template <class Look>
double mean_over_sky(double from_sine, bool on_ground, const Look& look) {
  double sum = 0.0;
  for (int i = 0; i < rings; ++i) {
    const double part = (i + 0.5) / rings;
    const double sine = on_ground ? std::sqrt(part) : from_sine + (1.0 - from_sine) * part;
    const double cosine = std::sqrt(1.0 - sine * sine);
    for (int k = 0; k < around; ++k) {
      const double azimuth = 2.0 * pi * k / around;
      sum += look(Vec<Enu>{cosine * std::sin(azimuth), cosine * std::cos(azimuth), sine});
    }
  }
  return sum / (rings * around);
}

double s10_of(const SkyModel& sky, const Vec<Enu>& direction) {
  double sum = 0.0;
  for (const double part : sky.parts_s10(direction)) sum += part;
  return sum;
}

std::optional<double> r0_m(const SensorConfig& sensor) {
  if (sensor.seeing && std::isfinite(sensor.seeing->r0_m)) return sensor.seeing->r0_m;
  if (!sensor.atmosphere.turbulence) return std::nullopt;
  const double r0 = turbulence(sensor.atmosphere.turbulence->profile, seeing_wavelength_m).r0_m;
  return std::isfinite(r0) ? std::optional(r0) : std::nullopt;
}

}  // namespace

double dew_point_c(const Weather& air) {
  constexpr double slope = 17.625, scale_c = 243.04, driest = 0.001;
  const double t = air.temperature_c;
  const double g = std::log(std::max(air.humidity, driest)) + slope * t / (scale_c + t);
  return scale_c * g / (slope - g);
}

double cloud_cover_percent(const Clouds& clouds, double time_s) {
  const CloudMap map(clouds);
  return 100.0 * mean_over_sky(0.5, false, [&](const Vec<Enu>& direction) {
           return 1.0 - map.transmission(direction, time_s);
         });
}

double sky_lux(const SkyModel& sky) {
  constexpr double cd_per_m2_of_nanolambert = 1e-9 * 1e4 / pi;
  const double mean_s10 =
      mean_over_sky(0.0, true, [&](const Vec<Enu>& direction) { return s10_of(sky, direction); });
  return pi * mean_s10 / s10_of_nanolambert(1.0) * cd_per_m2_of_nanolambert;
}

SiteConditions site_conditions(const SensorConfig& sensor, const Weather& air, const SkyModel& sky,
                               double time_s) {
  SiteConditions c{.air = air, .dew_point_c = dew_point_c(air)};
  if (sensor.weather.clouds)
    c.cloud_cover_percent = cloud_cover_percent(*sensor.weather.clouds, time_s);
  const double zenith_s10 = s10_of(sky, {0.0, 0.0, 1.0});
  if (zenith_s10 > 0.0) c.sky_mag_per_arcsec2 = mag_per_arcsec2_of_s10(zenith_s10);
  c.sky_lux = sky_lux(sky);
  // A long exposure has a FWHM of 0.976 wavelength / r0 (Dierickx 1992, J. Mod. Opt. 39, 569).
  if (const auto r0 = r0_m(sensor)) c.star_fwhm_arcsec = 0.976 * seeing_wavelength_m / *r0 / arcsec;
  if (sensor.atmosphere.turbulence)
    c.wind_m_per_s = sensor.atmosphere.turbulence->wind.ground_m_per_s;
  return c;
}

const SiteConditions& WeatherStation::conditions(SimTime now) {
  if (!last_ || now >= last_at_ + sim_seconds(every_s)) refresh(now);
  return *last_;
}

void WeatherStation::refresh(SimTime now) {
  last_ = measure_(now);
  last_at_ = now;
}

double WeatherStation::age_s(SimTime now) {
  conditions(now);
  return (now - last_at_).seconds();
}

}  // namespace dmise
