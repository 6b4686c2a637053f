#include "nodes/wire/state_rules.h"

#include <cmath>
#include <limits>
#include <tuple>
#include <type_traits>

#include "core/base/units.h"
#include "core/products/frame_report.h"
#include "nodes/wire/codecs.h"
#include "nodes/wire/field_rules.h"

namespace dmise {
namespace {

using namespace field_rules;

constexpr double distance_limit_m = 1e15;  // 6,700 au
constexpr double speed_limit_m_per_s = speed_of_light_m_per_s;
constexpr double rate_limit_rad_per_s = 1e6;
constexpr double albedo_limit = 1000.0;  // a glint is brighter than a diffuse sphere
constexpr std::size_t text_limit_bytes = 16384;
constexpr std::size_t max_path_numbers = 30000;

void frame_number(std::uint32_t frame) {
  if (frame == 0) refuse("frame", "counts from 1");
}

void exposure(SimTime start, SimTime middle, SimTime end) {
  if (start > middle || middle > end) refuse("exposure", "start, middle and end must be in order");
}

void check(const SunTrackingPanel& panel) {
  vector_within(panel.hinge, 1e9, "panel.hinge");
  vector_within(panel.normal, 1e9, "panel.normal");
  if (!(norm(cross(panel.hinge, panel.normal)) > 0))
    refuse("panel", "hinge and normal must span a plane");
}

void check(const ObjectRoster& roster) {
  for (const ObjectInfo& object : roster.objects) {
    if (object.catalogue_number > 999999999) refuse("catalogue_number", "has up to 9 digits");
    name_text(object.name, "name");
    name_text(object.designator, "designator");
    in_range(object.sphere.radius_m, std::numeric_limits<double>::min(), 1e9, "radius_m");
    in_range(object.sphere.albedo, std::numeric_limits<double>::min(), 1.0, "albedo");
    finite(object.element_age_s, "element_age_s");
    if (object.panel) check(*object.panel);
  }
  if (roster.elements.size() > roster.objects.size()) refuse("elements", "of more objects");
  for (const MeanElements& e : roster.elements)
    for (const auto row : element_rows) finite(e.*row, "elements");
}

void check_attitudes(const ObjectStates& s) {
  const std::size_t m = s.attitude_object.size();
  if (s.gcrs_from_body.size() != 4 * m || s.attitude_rate_rad_per_s.size() != 3 * m)
    refuse("attitude_object", "arrays have another size");
  for (std::size_t k = 0; k < m; ++k) {
    const std::size_t object = s.attitude_object[k];
    if (object >= s.count || (k > 0 && object <= s.attitude_object[k - 1]))
      refuse("attitude_object", "must be ascending indices of objects");
    const double wanted = s.code[object] == 0 ? 1.0 : 0.0;
    double square = 0.0;
    for (std::size_t i = k; i < 4 * m; i += m) square += s.gcrs_from_body[i] * s.gcrs_from_body[i];
    if (!(std::abs(square - wanted) < 1e-9))
      refuse("gcrs_from_body", "must be unit quaternions, or 0 without a state");
  }
  all_within(s.attitude_rate_rad_per_s, rate_limit_rad_per_s, "attitude_rate_rad_per_s");
}

void check(const ObjectStates& states) {
  if (states.position_m.size() != 3 * states.count ||
      states.slope_m_per_s.size() != 3 * states.count ||
      states.velocity_m_per_s.size() != 3 * states.count || states.code.size() != states.count)
    refuse("count", "arrays have another size");
  all_within(states.position_m, distance_limit_m, "position_m");
  all_within(states.velocity_m_per_s, speed_limit_m_per_s, "velocity_m_per_s");
  all_within(states.slope_m_per_s, speed_limit_m_per_s, "slope_m_per_s");  // often the velocity
  check_attitudes(states);
  if (!states.albedo.empty() && states.albedo.size() != states.count)
    refuse("albedo", "has another size");
  for (const double albedo : states.albedo)
    if (albedo != roster_albedo) in_range(albedo, 0.0, albedo_limit, "albedo");
}

void check(const EarthOrientation& earth) {
  rotates(earth.cirs_from_gcrs, "earth.cirs_from_gcrs");
  rotates(earth.itrs_from_tirs, "earth.itrs_from_tirs");
  finite(earth.era_rad, "earth.era_rad");
  finite(earth.era_rate_rad_per_s, "earth.era_rate_rad_per_s");
  finite(earth.gmst82_rad, "earth.gmst82_rad");
  finite(earth.gmst82_rate_rad_per_s, "earth.gmst82_rate_rad_per_s");
}

void check(const EnvironmentState& state) {
  check(state.earth);
  if (state.earth_beside) {
    for (const EarthOrientation& earth : *state.earth_beside) check(earth);
    if (state.earth_beside->front().time >= state.time ||
        state.earth_beside->back().time <= state.time)
      refuse("earth_beside", "must be before and after the state's time");
  }
  vector_within(state.sun_m, distance_limit_m, "sun_m");
  vector_within(state.moon_m, distance_limit_m, "moon_m");
  vector_within(state.earth_barycentric_m, distance_limit_m, "earth_barycentric_m");
  vector_within(state.earth_velocity_m_per_s, speed_limit_m_per_s, "earth_velocity_m_per_s");
  vector_within(state.moon_velocity_m_per_s, speed_limit_m_per_s, "moon_velocity_m_per_s");
  in_range(state.tt_jd1, -1e8, 1e8, "tt_jd1_days");
  in_range(state.tt_jd2, -1e8, 1e8, "tt_jd2_days");
}

void check(const SiteState& state) {
  name_text(state.sensor, "sensor");
  in_range(state.extinction_mag_per_airmass, 0, 10, "extinction_mag_per_airmass");
  in_range(state.pressure_hpa, 0, 10000, "pressure_hpa");
  in_range(state.temperature_c, -150, 200, "temperature_c");
  in_range(state.humidity, 0, 1, "humidity");
  in_range(state.cloud_transmission, 0, 1, "cloud_transmission");
  not_negative(state.r0_m, "r0_m");
  not_negative(state.isoplanatic_angle_rad, "isoplanatic_angle_rad");
  not_negative(state.tau0_s, "tau0_s");
  in_range(state.turbulence_m_per_s, 0, speed_limit_m_per_s, "turbulence_m_per_s");
}

void check(const Wcs& wcs) {
  finite(wcs.crpix_x, "wcs.crpix_x_px");
  finite(wcs.crpix_y, "wcs.crpix_y_px");
  direction(wcs.ra_rad, wcs.dec_rad, "wcs.ra_rad, dec_rad");
  for (const double value : wcs.cd_deg) finite(value, "wcs.cd_deg");
  if (wcs.order < 0 || wcs.order > 9) refuse("wcs.order", "must be 0 to 9");
  const std::size_t terms = std::size_t(wcs.order + 1) * std::size_t(wcs.order + 1);
  for (const auto* polynomial : {&wcs.a, &wcs.b, &wcs.ap, &wcs.bp}) {
    if (!(polynomial->size() == terms || (wcs.order == 0 && polynomial->empty())))
      refuse("wcs.order", "polynomials have another size");
    for (const double value : *polynomial) finite(value, "wcs polynomial");
  }
  not_negative(wcs.rms_px, "wcs.rms_px");
  not_negative(wcs.max_px, "wcs.max_px");
  if (!wcs.refraction) return;
  const WcsRefraction& air = *wcs.refraction;
  in_range(norm(air.zenith), 1 - 1e-6, 1 + 1e-6, "wcs.refraction.zenith");
  in_range(air.focal_length_px, 1e-9, 1e15, "wcs.refraction.focal_length_px");
  in_range(air.pressure_hpa, 0, 1e4, "wcs.refraction.pressure_hpa");
  in_range(air.temperature_c, -150, 200, "wcs.refraction.temperature_c");
  in_range(air.humidity, 0, 1, "wcs.refraction.humidity");
  in_range(air.wavelength_um, 0.1, 100, "wcs.refraction.wavelength_um");
  finite(air.offset_x_px, "wcs.refraction.offset_x_px");
  finite(air.offset_y_px, "wcs.refraction.offset_y_px");
  in_range(air.cell_px, 1, 1e6, "wcs.refraction.cell_px");
}

void check(const FrameReport& report) {
  name_text(report.sensor, "sensor");
  frame_number(report.frame);
  exposure(report.start, report.middle, report.end);
  direction(report.boresight_ra_rad, report.boresight_dec_rad, "boresight");
  check(report.wcs);
  vector_within(report.sensor_position_m, distance_limit_m, "sensor_position_m");
  vector_within(report.sensor_velocity_m_per_s, speed_limit_m_per_s, "sensor_velocity_m_per_s");
  finite(report.limiting_magnitude, "limiting_magnitude");
  finite(report.background_e, "background_e");
  not_negative(report.noise_e, "noise_e");
  finite(report.zero_point_mag, "zero_point_mag");
  finite(report.magnitudes.solar_colour_mag, "solar_colour_mag");
  utf8(report.plan, text_limit_bytes, "plan");
  not_negative(report.psf_fwhm_px, "psf_fwhm_px");
}

/// Refuses a number of a product that is not finite.
struct FiniteFields {
  template <class T>
  void operator()(const char* name, const T& member, const char* = nullptr, double = 1.0) {
    if constexpr (std::is_same_v<T, double>) finite(member, name);
    if constexpr (std::is_same_v<T, std::optional<double>>) finite(member.value_or(0.0), name);
  }
  void pair(const char* x_name, double x, const char* y_name, double y, const char*) {
    finite(x, x_name);
    finite(y, y_name);
  }
  void pair_or_null(bool, const char* x_name, double x, const char* y_name, double y,
                    const char* key) {
    pair(x_name, x, y_name, y, key);
  }
  void constant(const char*, const char*) {}
  void absent_unless(bool, const char* name, const auto& member, const char* = nullptr) {
    (*this)(name, member);
  }
};

void check(const LightPeriod& p) {
  for (const auto& [value, field] :
       {std::pair(p.period_px, "light_curve.period.period_px"),
        std::pair(p.period_sigma_px, "light_curve.period.period_sigma_px"),
        std::pair(p.period_s, "light_curve.period.period_s"),
        std::pair(p.period_sigma_s, "light_curve.period.period_sigma_s"),
        std::pair(p.amplitude, "light_curve.period.amplitude"),
        std::pair(p.amplitude_sigma, "light_curve.period.amplitude_sigma")})
    not_negative(value, field);
  in_range(p.false_alarm, 0, 1, "light_curve.period.false_alarm");
}

void check(const LightCurve& light) {
  not_negative(light.bin_px, "light_curve.bin_px");
  for (const auto& [list, field] : {std::pair(&light.along_px, "light_curve.along_px"),
                                    std::pair(&light.time_s, "light_curve.time_s"),
                                    std::pair(&light.light_e, "light_curve.light_e"),
                                    std::pair(&light.sigma_e, "light_curve.sigma_e"),
                                    std::pair(&light.correlation, "light_curve.correlation")}) {
    if (list->size() != light.along_px.size()) refuse(field, "must be as long as along_px");
    for (const double value : *list) finite(value, field);
  }
  for (const double sigma : light.sigma_e) not_negative(sigma, "light_curve.sigma_e");
  for (const double c : light.correlation) in_range(c, -1, 1, "light_curve.correlation");
  not_negative(light.min_period_px.value_or(0.0), "light_curve.min_period_px");
  not_negative(light.min_period_s.value_or(0.0), "light_curve.min_period_s");
  if (light.period) check(*light.period);
}

void check(const Detection& d) {
  name_text(d.id, "id");
  name_text(d.sensor, "sensor");
  name_text(d.band, "band");
  frame_number(d.frame);
  direction(d.ra_rad, d.dec_rad, "ra_rad, dec_rad");
  direction(d.corrected_ra_rad, d.corrected_dec_rad, "corrected_ra_rad, corrected_dec_rad");
  direction(d.end1_ra_rad, d.end1_dec_rad, "end1_ra_rad, end1_dec_rad");
  direction(d.end2_ra_rad, d.end2_dec_rad, "end2_ra_rad, end2_dec_rad");
  covariance(d.covariance_rad2, "covariance_rad2");
  covariance(d.covariance_px2, "covariance_px2");
  covariance(d.end1_covariance_rad2, "end1_covariance_rad2");
  covariance(d.end2_covariance_rad2, "end2_covariance_rad2");
  vector_within(d.sensor_position_m, distance_limit_m, "sensor_position_m");
  vector_within(d.sensor_velocity_m_per_s, speed_limit_m_per_s, "sensor_velocity_m_per_s");
  vector_within(d.refraction_offset_m, distance_limit_m, "refraction_offset_m");
  not_negative(d.refraction_parallax_rad, "refraction_parallax_rad");
  not_negative(d.refraction_parallax_sigma_rad, "refraction_parallax_sigma_rad");
  not_negative(d.magnitude_sigma, "magnitude_sigma");
  not_negative(d.length_px, "length_px");
  not_negative(d.rate_rad_per_s, "rate_rad_per_s");
  for (const auto& [value, sigma, field] :
       {std::tuple(&d.range_m, &d.range_sigma_m, "range_sigma_m"),
        std::tuple(&d.range_rate_m_per_s, &d.range_rate_sigma_m_per_s, "range_rate_sigma_m_per_s")})
    if (value->has_value() != sigma->has_value() || !(sigma->value_or(1.0) > 0.0))
      refuse(field, "must be > 0, where there is what it is of");
  if (d.light_curve) check(*d.light_curve);
  FiniteFields finite_fields;
  visit_fields(finite_fields, d);
}

void check(const DetectionSet& set) {
  name_text(set.sensor, "sensor");
  frame_number(set.frame);
  for (const Detection& d : set.detections) {
    check(d);
    if (d.sensor != set.sensor || d.frame != set.frame)
      refuse("detections", "of another sensor or frame");
  }
}

void check(const TruthSet& set) {
  name_text(set.sensor, "sensor");
  frame_number(set.frame);
  for (const Truth& t : set.truths) {
    if (t.sensor != set.sensor || t.frame != set.frame)
      refuse("truths", "of another sensor or frame");
    name_text(t.name, "name");
    exposure(t.start, t.middle, t.end);
    vector_within(t.true_position_m, distance_limit_m, "true_position_m");
    vector_within(t.true_velocity_m_per_s, speed_limit_m_per_s, "true_velocity_m_per_s");
    in_range(t.true_range_m, 0, distance_limit_m, "true_range_m");
    direction(t.true_ra_rad, t.true_dec_rad, "true_ra_rad, true_dec_rad");
    direction(t.apparent_ra_rad, t.apparent_dec_rad, "apparent_ra_rad, apparent_dec_rad");
    in_range(t.true_elevation_rad, -latitude_limit_rad, latitude_limit_rad, "true_elevation_rad");
    in_range(t.phase_angle_rad, 0, pi * (1 + 1e-12), "phase_angle_rad");
    in_range(t.sunlit, 0, 1, "sunlit");
    not_negative(t.rendered_signal_e, "rendered_signal_e");
    not_negative(t.defocus_disc_px, "defocus_disc_px");
    FiniteFields finite_fields;
    visit_fields(finite_fields, t);
    if (const auto& q = t.camera_from_gcrs)
      in_range(q->w * q->w + q->x * q->x + q->y * q->y + q->z * q->z, 1 - 1e-6, 1 + 1e-6,
               "camera_from_gcrs");
  }
}

void check(const Track& t) {
  if (t.id == 0) refuse("id", "counts from 1");
  if (t.catalogue_number > 999999999) refuse("catalogue_number", "has up to 9 digits");
  name_text(t.name, "name");
  for (const std::string& id : t.associated) name_text(id, "associated");
  vector_within(t.position_m, distance_limit_m, "position_m");
  vector_within(t.velocity_m_per_s, speed_limit_m_per_s, "velocity_m_per_s");
  covariance(t.covariance, "covariance");
  for (const double scale : {t.drag_m2_per_kg, t.srp_m2_per_kg}) finite(scale, "scales");
  not_negative(t.drag_sigma_m2_per_kg, "drag_sigma_m2_per_kg");
  not_negative(t.srp_sigma_m2_per_kg, "srp_sigma_m2_per_kg");
  in_range(t.existence, 0, 1, "existence");
  not_negative(t.innovation_d2, "innovation_d2");
  finite(t.magnitude, "magnitude");
}

void check(const TrackSet& set) {
  name_text(set.node, "node");
  for (std::size_t i = 0; i < set.tracks.size(); ++i) {
    check(set.tracks[i]);
    if (set.tracks[i].time != set.time) refuse("time", "of another tick");
    if (i > 0 && set.tracks[i].id <= set.tracks[i - 1].id) refuse("tracks", "must be by id");
  }
}

void check(const Task& t) {
  if (t.id == 0) refuse("id", "counts from 1");
  if (t.track == 0) refuse("track", "counts from 1");
  if (t.catalogue_number > 999999999) refuse("catalogue_number", "has up to 9 digits");
  name_text(t.sensor, "sensor");
  name_text(t.name, "name");
  if (!(t.given <= t.start && t.start <= t.on_target && t.on_target < t.end))
    refuse("times", "must be given <= start <= on_target < end");
  if (t.path_m.size() < 6 || t.path_m.size() % 3 != 0 || t.path_m_per_s.size() != t.path_m.size())
    refuse("path_m", "must have 3 numbers of each of 2 points or more, as path_m_per_s");
  if (t.path_m.size() > max_path_numbers) refuse("path_m", "is too long");
  in_range(t.path_step_s, 1e-3, 1e6, "path_step_s");
  all_within(t.path_m, distance_limit_m, "path_m");
  all_within(t.path_m_per_s, speed_limit_m_per_s, "path_m_per_s");
  covariance(t.covariance, "covariance");
  in_range(t.in_field, 0, 1, "in_field");
  in_range(t.detection_probability, 0, 1, "detection_probability");
  not_negative(t.sigma_rad, "sigma_rad");
  in_range(t.slew_rad, 0, 2 * pi, "slew_rad");
  not_negative(t.slew_s, "slew_s");
  not_negative(t.gain_nats, "gain_nats");
  not_negative(t.gain_nats_per_s, "gain_nats_per_s");
  not_negative(t.runner_up_nats_per_s, "runner_up_nats_per_s");
}

void check(const TaskSet& set) {
  name_text(set.node, "node");
  name_text(set.sensor, "sensor");
  for (std::size_t i = 0; i < set.tasks.size(); ++i) {
    check(set.tasks[i]);
    if (set.tasks[i].sensor != set.sensor) refuse("sensor", "of another sensor");
    if (set.tasks[i].given != set.time) refuse("given", "of another tick");
    if (i > 0 && set.tasks[i].id <= set.tasks[i - 1].id) refuse("tasks", "must be by id");
  }
}

// Topic, tick and time of a state.
struct Place {
  std::string topic;
  const Tick* tick = nullptr;
  const SimTime* time = nullptr;
};

Place place(const ObjectRoster&) { return {roster_topic}; }
Place place(const ObjectStates& s) { return {objects_topic, &s.tick, &s.time}; }
Place place(const EnvironmentState& s) { return {environment_topic, &s.tick, &s.time}; }
Place place(const SiteState& s) { return {site_prefix + s.sensor, &s.tick, &s.time}; }
Place place(const FrameReport& report) { return {frame_prefix + report.sensor}; }
Place place(const DetectionSet& set) { return {detection_prefix + set.sensor}; }
Place place(const TruthSet& set) { return {truth_prefix + set.sensor}; }
Place place(const TrackSet& set) { return {track_prefix + set.node, &set.tick, &set.time}; }
Place place(const TaskSet& set) { return {task_prefix + set.sensor, &set.tick, &set.time}; }

}  // namespace

void check(const State& state) {
  std::visit([](const auto& s) { check(s); }, state);
}

void check_place(const std::string& topic, const Envelope& envelope, const State& state) {
  const Place where = std::visit([](const auto& s) { return place(s); }, state);
  // The roster precedes the states on their topic as well.
  const bool on_either = topic == objects_topic && std::holds_alternative<ObjectRoster>(state);
  const bool of_actor =
      topic.starts_with(actor_prefix) && std::holds_alternative<ObjectStates>(state);
  if (topic != where.topic && !on_either && !of_actor)
    throw Refused(Refusal::topic, topic + ": a state of " + where.topic);
  if ((where.tick && *where.tick != envelope.tick) || (where.time && *where.time != envelope.time))
    throw Refused(Refusal::tick, topic + ": the state is of another tick than its envelope");
}

}  // namespace dmise
