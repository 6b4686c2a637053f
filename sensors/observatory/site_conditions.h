#pragma once
#include <functional>
#include <optional>

#include "core/base/sim_time.h"
#include "core/config/sensors/sensor_settings.h"
#include "core/sky/sky_model.h"

namespace dmise {

/// The air over a site as the instruments of an observatory measure it. None: the scenario does not
/// say.
struct SiteConditions {
  Weather air = {};
  double dew_point_c = 0.0;
  double cloud_cover_percent = 0.0;
  std::optional<double> sky_mag_per_arcsec2 = {};  // V, at the zenith; none: it is black
  double sky_lux = 0.0;                            // on the ground, by the sky without Sun and Moon
  std::optional<double> star_fwhm_arcsec = {};     // made by the air at 0.5 um, in a long exposure
  std::optional<double> wind_m_per_s = {};         // on the ground
};

/// Temperature at which air becomes saturated [C]; of dry air that of 0.1 % humidity. Source:
/// Magnus' formula of Alduchov & Eskridge 1996, J. Appl. Meteor. 35, 601, equation 21: within 0.4 %
/// of the vapour pressure from -40 to 50 C.
double dew_point_c(const Weather& air);

/// Share of light from above 30 deg that clouds keep out [%].
double cloud_cover_percent(const Clouds& clouds, double time_s);

/// Light of the whole sky on level ground [lux].
double sky_lux(const SkyModel& sky);

SiteConditions site_conditions(const SensorConfig& sensor, const Weather& air, const SkyModel& sky,
                               double time_s);

/// Instruments that measure the air every ten seconds. Times that calls are given must not
/// decrease.
class WeatherStation {
 public:
  static constexpr double every_s = 10.0;

  explicit WeatherStation(std::function<SiteConditions(SimTime)> measure)
      : measure_(std::move(measure)) {}

  const SiteConditions& conditions(SimTime now);
  void refresh(SimTime now);
  /// Since the last measurement.
  double age_s(SimTime now);

 private:
  std::function<SiteConditions(SimTime)> measure_;
  std::optional<SiteConditions> last_;
  SimTime last_at_;
};

}  // namespace dmise
