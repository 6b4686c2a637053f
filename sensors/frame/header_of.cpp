#include "sensors/frame/header_of.h"

#include <algorithm>
#include <cmath>
#include <optional>

#include "core/base/units.h"
#include "core/base/version.h"
#include "core/optics/projection.h"
#include "core/sky/air/air_exposure.h"
#include "core/time/iso8601.h"
#include "core/wcs/wcs_fit.h"
#include "sensors/scene/throughput.h"

namespace dmise {
namespace {

/// The WCS of mid exposure, with the refraction and aberration of the stars.
Wcs wcs_of(const View& view) {
  const auto& sensor = view.sensor();
  const Optics& optics = sensor.camera.optics;
  const SimTime middle = view.times().middle;
  const auto places = view.places(middle);
  const auto camera_from_gcrs = view.camera_from_gcrs(middle);
  const auto gcrs_from_camera = camera_from_gcrs.inverse();
  std::optional<CameraAir> air;
  if (view.on_ground() && sensor.effects.has(AtmosphericRefraction::facts))
    air = CameraAir{camera_from_gcrs * view.up(middle), view.refraction()};
  const auto star_at = [&](PixelPosition pixel) -> std::optional<Vec<Gcrs>> {
    const auto seen = unproject(optics, pixel);
    if (!seen) return std::nullopt;
    if (!view.rolls()) return places.star_seen_at(gcrs_from_camera * *seen);
    // The middle of its own row's exposure.
    const SimTime own = middle + view.row_delay(pixel.y_px);
    return places.star_seen_at(view.camera_from_gcrs(own).inverse() * *seen);
  };
  return best_wcs(optics, star_at, air);
}

/// What archives index of a frame. `centre`: ICRS direction of the stars in the frame's centre.
Observation observation_of(const View& view, const PipelineSettings& settings,
                           const std::optional<Vec<Gcrs>>& centre) {
  const auto& sensor = settings.sensor;
  const SimTime middle = view.times().middle;
  Observation o{.telescope = header_text(sensor.camera.name)};
  if (const auto target = view.target())
    o.object = header_text(view.states().roster().objects[*target].name);
  const Utc start = settings.clock.utc(view.times().start);
  o.start_mjd = (start.jd1 - mjd_zero_jd) + start.jd2;
  if (centre) {
    const auto [ra, dec] = to_spherical(*centre);
    o.ra_rad = ra < 2 * pi ? ra : 0.0;
    o.dec_rad = dec;
  }
  if (!view.on_ground()) return o;
  const Vec<Gcrs> up = view.up(middle);
  // The camera sees apparent places: this altitude has the refraction in it.
  if (const double altitude = elevation_over(up, unit(view.boresight(middle))); altitude >= 0.0)
    o.airmass = airmass(altitude);
  const auto& environment = view.environment();
  const Vec<Gcrs> here_m = view.observer(middle).position_m;
  // The Sun's light time and the Earth's aberration together: 20 arcsec.
  o.sun_altitude_rad =
      elevation_over(up, unit(unit(environment.sun_m - here_m) +
                              environment.earth_velocity_m_per_s / speed_of_light_m_per_s));
  o.moon_altitude_rad = elevation_over(up, unit(environment.moon_m - here_m));
  return o;
}

}  // namespace

FrameHeader header_of(const View& view, const PipelineSettings& settings, double psf_fwhm_px) {
  const auto& sensor = settings.sensor;
  const EffectSet& ran = view.sensor().effects;  // in this exposure
  const auto& optics = sensor.camera.optics;
  const Detector detector = acting_detector(sensor.camera.detector, sensor.effects);
  const auto& times = view.times();
  const auto& environment = view.environment();
  const ObserverState observer = view.observer(times.middle);
  const Throughput throughput(view);
  const auto utc = [&](SimTime t) { return format_utc(settings.clock.utc(t), 6); };
  FrameHeader h{
      .sensor = sensor.name,
      .frame = times.frame,
      .start = times.start,
      .middle = times.middle,
      .end = times.end,
      .start_utc = utc(times.start),
      .middle_utc = utc(times.middle),
      .end_utc = utc(times.end),
      .exposure_s = times.seconds(),
      .mount = tracking_name(sensor.tracking),
      .software = software_name(),
      .scenario_digest = settings.digest,
      .seed = settings.seed,
      .gain_e_per_dn = detector.gain_e_per_dn,
      .bias_dn = detector.bias_dn,
      .read_noise_e = detector.read_noise_e,
      .dark_e_per_s = detector.dark_e_per_s,
      .full_well_e = detector.full_well_e,
      .detector = detector,
      .psf_fwhm_px = psf_fwhm_px,
      .band = sensor.camera.band,
      .zero_point_mag = throughput.zero_point_mag() + sensor.camera.magnitudes.solar_colour_mag,
      .magnitudes = sensor.camera.magnitudes,
      .extinction_mag_per_airmass = throughput.extinction_mag_per_airmass(),
      .projection = optics.projection,
      .focal_length_px = optics.focal_length_px(),
      .sensor_position_m = observer.position_m,
      .sensor_velocity_m_per_s = observer.velocity_m_per_s};
  // No aberration is put back in a frame whose stars have none.
  if (ran.has(AnnualAberration::facts))
    h.earth_velocity_m_per_s = environment.earth_velocity_m_per_s;
  h.band.name = header_text(h.band.name);
  h.exclusion = sensor.camera.exclusion;
  h.dark = sensor.camera.dark;
  h.image_optics = acting_optics(optics.image, sensor.effects);
  if (const FocusDrift& drift = optics.spread.drift;
      drift.any() && ran.has(PointSpread::facts) && ran.has(FocusDrift::facts))
    h.defocus_um = 1e6 * (optics.spread.defocus_m + drift.at_m(times.middle.seconds()));
  if (ran.has(Vignetting::facts)) {
    h.illumination = optics.vignetting.table;
    h.illumination_radius = optics.vignetting.table_radius;
  }
  if (const SiteState* air = view.air()) {
    h.r0_m = air->r0_m;
    h.isoplanatic_angle_rad = air->isoplanatic_angle_rad;
    h.tau0_s = air->tau0_s;
  }
  if (const auto& site = view.site()) {
    h.site = SitePlace{site->latitude_deg * deg, site->longitude_deg * deg, site->height_m,
                       itrs_from_geodetic(*site)};
    h.air = view.weather();
    if (!ran.has(AtmosphericRefraction::facts)) h.air->pressure_hpa = 0.0;
  }
  const double max_dn = std::exp2(detector.adc_bits) - 1;
  const double well_e = h.full_well_e * (1.0 - detector.nonlinearity) *
                        (1.0 - 4.0 * detector.interpixel_coupling);  // what is left of a full one
  const double well_dn = well_e / h.gain_e_per_dn + h.bias_dn;
  // Without noise a full pixel has this count, or one more.
  h.saturation_dn =
      detector.well_is_limited ? std::min(max_dn, std::floor(well_dn + 1e-6)) : max_dn;
  const SimTime at[3] = {times.start, times.middle, times.end};
  for (int k = 0; k < 3; ++k) h.camera_from_gcrs[k] = quaternion_of(view.camera_from_gcrs(at[k]));

  const Vec<Gcrs> axis = view.boresight(times.middle);
  h.observation = observation_of(view, settings, view.places(times.middle).star_seen_at(axis));
  h.wcs = wcs_of(view);
  return h;
}

}  // namespace dmise
