#include "tests/wire/examples.h"

#include "core/products/frame_report.h"
#include "nodes/wire/state_codec.h"

namespace dmise::test {
namespace {

constexpr double half_turn = 3.14159265358979;
constexpr const char* sensor = "atlanta";

template <class To, class From>
Rotation<To, From> rotation(double angle_rad) {
  const double c = std::cos(angle_rad), s = std::sin(angle_rad);
  return {{{{c, s, 0}, {-s, c, 0}, {0, 0, 1}}}};
}

ObjectRoster roster(Numbers& n) {
  ObjectRoster r;
  for (std::uint32_t i = 0; i < 5; ++i)
    r.objects.push_back({.catalogue_number = 999999999 - i,
                         .name = "ÉTOILE " + std::to_string(i),
                         .designator = i % 2 ? "" : "1998-067A",
                         .sphere = {n.in(0.01, 50), n.in(0.01, 1)},
                         .element_age_s = n.in(-1e7, 1e7)});
  for (std::size_t i = 0; i < 3; ++i)
    r.elements.push_back({.epoch_jd1 = 2458138.5,
                          .epoch_jd2 = n.in(0, 1),
                          .mean_motion_rad_per_min = n.in(0.004, 0.07),
                          .eccentricity = n.in(0, 0.7),
                          .inclination_rad = n.in(0, half_turn),
                          .raan_rad = n.in(0, 2 * half_turn),
                          .argument_of_perigee_rad = n.in(0, 2 * half_turn),
                          .mean_anomaly_rad = n.in(0, 2 * half_turn),
                          .bstar_per_earth_radius = n.in(-1e-4, 1e-3)});
  const double hinge = n.in(1, 2), normal = n.in(1, 2);
  r.objects[2].panel =
      SunTrackingPanel{.hinge = {hinge, hinge, hinge}, .normal = {normal, -2 * normal, normal}};
  return r;
}

ObjectStates states(Numbers& n, Tick tick) {
  ObjectStates s;
  s.tick = tick;
  s.time = example_run().time_of(tick);
  s.count = 7;
  for (std::size_t i = 0; i < 3 * s.count; ++i) {
    s.position_m.push_back(i == 3 ? -0.0 : n.in(-4e7, 4e7));
    s.slope_m_per_s.push_back(i == 4 ? 5e-324 : n.in(-8e3, 8e3));
    s.velocity_m_per_s.push_back(n.in(-8e3, 8e3));
  }
  s.code = {0, 1, 2, 3, 4, 6, 255};
  s.attitude_object = {0, 5};  // one with a state, one without
  s.gcrs_from_body = {0.5, 0, -0.5, 0, 0.5, 0, 0.5, 0};
  s.attitude_rate_rad_per_s = {n.in(-9, 9), 0, n.in(-9, 9), 0, n.in(-9, 9), 0};
  return s;
}

EnvironmentState environment(Numbers& n, Tick tick) {
  EnvironmentState e;
  e.tick = tick;
  e.time = example_run().time_of(tick);
  e.earth.time = e.time;
  e.earth.cirs_from_gcrs = rotation<Cirs, Gcrs>(n.in(-1, 1));
  e.earth.itrs_from_tirs = rotation<Itrs, Tirs>(n.in(-1e-6, 1e-6));
  e.earth.era_rad = n.in(0, 2 * half_turn);
  e.earth.gmst82_rad = n.in(0, 2 * half_turn);
  e.earth.era_rate_rad_per_s = n.in(7e-5, 8e-5);
  e.earth.gmst82_rate_rad_per_s = n.in(7e-5, 8e-5);
  e.earth_beside = {e.earth, e.earth};
  e.earth_beside->front().time.ns -= 125'000'000;
  e.earth_beside->back().time.ns += 125'000'000;
  e.sun_m = n.vec<Gcrs>(1.5e11);
  e.moon_m = n.vec<Gcrs>(4e8);
  e.earth_barycentric_m = n.vec<Gcrs>(1.5e11);
  e.earth_velocity_m_per_s = n.vec<Gcrs>(3e4);
  e.moon_velocity_m_per_s = n.vec<Gcrs>(1e3);
  e.tt_jd1 = 2458139.5;
  e.tt_jd2 = n.in(0, 1);
  return e;
}

SiteState site(Numbers& n, Tick tick) {
  return {.tick = tick,
          .time = example_run().time_of(tick),
          .sensor = sensor,
          .extinction_mag_per_airmass = n.in(0, 1),
          .pressure_hpa = n.in(500, 1100),
          .temperature_c = n.in(-40, 40),
          .humidity = n.in(0, 1),
          .cloud_transmission = n.in(0, 1),
          .r0_m = n.in(0.01, 1),
          .isoplanatic_angle_rad = n.in(1e-6, 1e-4),
          .tau0_s = n.in(1e-4, 1e-1),
          .turbulence_m_per_s = n.in(1, 100)};
}

/// The row of the table of projections with the most coefficients; one that FITS has, or any.
Projection calibrated(bool fits) {
  Projection most = Projection::equisolid;
  const auto rows = Projection::rows();
  for (std::size_t i = 0; i < rows.size(); ++i)
    if ((rows[i].fits_code || !fits) && rows[i].coefficients.size() > most.coefficients().size())
      most = Projection::make(i, std::vector<double>(rows[i].coefficients.size(), 0.01));
  return most;
}

FrameReport report(Numbers& n) {
  FrameReport r;
  r.sensor = sensor;
  r.frame = 3;
  r.start = {-7};
  r.middle = {10'000'000'000};
  r.end = {20'000'000'007};
  r.boresight_ra_rad = n.in(0, 2 * half_turn);
  r.boresight_dec_rad = n.in(-half_turn / 2, half_turn / 2);
  r.wcs = {.crpix_x = n.in(0, 3000),
           .crpix_y = n.in(0, 2000),
           .ra_rad = n.in(0, 6),
           .dec_rad = n.in(-1, 1),
           .cd_deg = {n.in(-1, 1), n.in(-1, 1), n.in(-1, 1), n.in(-1, 1)},
           .order = 3};
  for (auto* polynomial : {&r.wcs.a, &r.wcs.b, &r.wcs.ap, &r.wcs.bp})
    for (int i = 0; i < 16; ++i) polynomial->push_back(n.in(-1e-5, 1e-5));
  r.wcs.projection = calibrated(true);
  const auto zenith = n.vec<CameraFrame>(1.0);
  r.wcs.refraction = {.zenith = unit(zenith),
                      .focal_length_px = n.in(100, 1000),
                      .lens = calibrated(false),
                      .pressure_hpa = n.in(500, 1000),
                      .temperature_c = n.in(-20, 30),
                      .humidity = n.in(0, 1),
                      .wavelength_um = n.in(0.4, 2),
                      .offset_x_px = n.in(-9, 9),
                      .offset_y_px = n.in(-9, 9),
                      .cell_px = n.in(2, 20)};
  r.wcs.rms_px = n.in(0, 1);
  r.wcs.max_px = n.in(1, 2);
  r.sensor_position_m = n.vec<Gcrs>(7e6);
  r.sensor_velocity_m_per_s = n.vec<Gcrs>(8e3);
  r.limiting_magnitude = n.in(5, 20);
  r.background_e = n.in(0, 1e4);
  r.noise_e = n.in(1, 100);
  r.zero_point_mag = n.in(15, 25);
  r.magnitudes = {MagnitudeSystem::ab, n.in(-1, 1)};
  r.detections = 2;
  r.star_like = 900;
  r.saturated_px = 4;
  r.stars_rendered = 1234;
  r.objects_rendered = 17;
  r.plan = "proper_motion refraction photon_noise";
  r.detection_off = true;
  r.excluded = {.sun = true, .moon = true, .earth_limb = true};
  r.shutter_closed = true;
  r.psf_fwhm_px = n.in(1, 4);
  r.psf_stars = 99;
  r.stars_expected = 120;
  r.stars_found = 118;
  return r;
}

Detection detection(Numbers& n, std::uint32_t index) {
  Detection d;
  d.id = std::string(sensor) + "/3/" + std::to_string(index);
  d.sensor = sensor;
  d.frame = 3;
  d.index = index;
  d.kind = index % 2 ? DetectionKind::streak : DetectionKind::point;
  d.epoch = ExposureEpoch(index % 3);
  d.time = {std::int64_t(n.in(0, 1e11))};
  const auto angle = [&] { return n.in(0, 2 * half_turn); };
  const auto latitude = [&] { return n.in(-half_turn / 2, half_turn / 2); };
  d.ra_rad = angle(), d.dec_rad = latitude();
  d.corrected_ra_rad = angle(), d.corrected_dec_rad = latitude();
  d.covariance_rad2 = {n.in(1, 2) * 1e-12, n.in(-1, 1) * 1e-12, n.in(1, 2) * 1e-12};
  d.sensor_position_m = n.vec<Gcrs>(7e6);
  d.sensor_velocity_m_per_s = n.vec<Gcrs>(8e3);
  d.light_time_removed = index % 2;
  d.aberration_removed = index % 3;
  d.refraction_removed = index % 5;
  d.refraction_offset_m = n.vec<Gcrs>(100);
  d.refraction_parallax_rad = n.in(0, 1e-5), d.refraction_parallax_sigma_rad = n.in(0, 1e-5);
  d.magnitude = n.in(-1, 20);
  d.magnitude_system = MagnitudeSystem::vega;
  d.magnitude_sigma = n.in(0, 1);
  d.band = "swir140";
  d.snr = n.in(3, 1000);
  d.x_px = n.in(0, 3000), d.y_px = n.in(0, 2000);
  d.covariance_px2 = {n.in(1, 2), n.in(-1, 1), n.in(1, 2)};
  d.end1_covariance_rad2 = {n.in(1, 2), n.in(-1, 1), n.in(1, 2)};
  d.end2_covariance_rad2 = {n.in(1, 2), n.in(-1, 1), n.in(1, 2)};
  d.signal_e = n.in(0, 1e6);
  d.end1_x_px = n.in(0, 3000), d.end1_y_px = n.in(0, 3000);
  d.end2_x_px = n.in(0, 3000), d.end2_y_px = n.in(0, 3000);
  d.end1_ra_rad = angle(), d.end1_dec_rad = latitude();
  d.end2_ra_rad = angle(), d.end2_dec_rad = latitude();
  d.end1_time = {-1}, d.end2_time = {std::int64_t(n.in(0, 1e11))};
  d.direction_known = index % 2;
  d.length_px = n.in(0, 100);
  d.rate_rad_per_s = n.in(0, 0.1);
  d.position_angle_rad = angle();
  d.saturated = d.at_edge = index % 2;
  d.star_like = index % 3;
  d.excluded = index % 2 == 0;
  if (index % 2) return d;
  d.light_curve =
      LightCurve{.bin_px = 2.5,
                 .along_px = {n.in(0, 2), n.in(2, 4)},
                 .time_s = {n.in(0, 1), n.in(1, 2)},
                 .light_e = {n.in(-10, 1e5), n.in(-10, 1e5)},
                 .sigma_e = {n.in(1, 100), n.in(1, 100)},
                 .correlation = {n.in(-0.5, 0), n.in(-0.5, 0)},
                 .period = LightPeriod{n.in(10, 20), n.in(0, 1), n.in(1, 2), n.in(0, 0.1),
                                       n.in(0, 1), n.in(0, 0.1), 3, n.in(0, 1e-3)},
                 .min_period_px = n.in(10, 20),
                 .min_period_s = n.in(1, 2)};
  d.range_m = n.in(1e5, 1e7), d.range_sigma_m = n.in(1, 100);
  d.range_rate_m_per_s = n.in(-8e3, 8e3), d.range_rate_sigma_m_per_s = n.in(0.1, 10);
  return d;
}

Truth truth(Numbers& n) {
  Truth t;
  t.sensor = sensor;
  t.frame = 3;
  t.catalogue_number = 44720;
  t.name = "STARLINK-1008";
  t.start = {-1}, t.middle = {1}, t.end = {2};
  t.true_position_m = {n.in(-4e7, 4e7), n.in(-4e7, 4e7), n.in(-4e7, 4e7)};
  t.true_velocity_m_per_s = {n.in(-8e3, 8e3), n.in(-8e3, 8e3), n.in(-8e3, 8e3)};
  for (double* range : {&t.true_range_m, &t.rendered_signal_e}) *range = n.in(0, 4e7);
  for (double* angle : {&t.true_ra_rad, &t.apparent_ra_rad}) *angle = n.in(0, 2 * half_turn);
  for (double* latitude : {&t.true_dec_rad, &t.apparent_dec_rad, &t.true_elevation_rad})
    *latitude = n.in(-half_turn / 2, half_turn / 2);
  t.phase_angle_rad = n.in(0, half_turn);
  t.sunlit = n.in(0, 1);
  for (double* value : {&t.true_magnitude, &t.rendered_x_px, &t.rendered_y_px, &t.start_x_px,
                        &t.start_y_px, &t.middle_x_px, &t.middle_y_px, &t.end_x_px, &t.end_y_px})
    *value = n.in(-100, 4000);
  t.in_frame = true;
  t.whole = n.in(0, 1) > 0.5;
  t.resolved = n.in(0, 1) > 0.5;
  t.defocus_disc_px = n.in(0, 100);
  t.camera_from_gcrs = Quaternion{0.5, -0.5, 0.5, 0.5};
  return t;
}

Track track(Numbers& n, std::uint32_t id, SimTime time) {
  Track t;
  t.id = id;
  t.status = TrackStatus(id % 3);
  t.time = time;
  t.position_m = n.vec<Gcrs>(4e7), t.velocity_m_per_s = n.vec<Gcrs>(8e3);
  for (double& c : t.covariance) c = n.in(0, 1e6);
  t.drag_m2_per_kg = n.in(0, 1), t.drag_sigma_m2_per_kg = n.in(0, 1);
  t.srp_m2_per_kg = n.in(0, 1), t.srp_sigma_m2_per_kg = n.in(0, 1);
  t.catalogue_number = 44720;
  t.name = "STARLINK-1008";
  t.existence = n.in(0, 1);
  t.detections = 12;
  t.associated = {std::string(sensor) + "/3/0", "boston/3/7"};
  t.innovation_d2 = n.in(0, 10);
  t.last_seen = {std::int64_t(n.in(0, 1e11))};
  t.magnitude = n.in(-1, 20);
  return t;
}

Task task(Numbers& n, std::uint32_t id, SimTime time) {
  Task t;
  t.id = id;
  t.sensor = sensor;
  t.track = 7;
  t.catalogue_number = 44720;
  t.name = "STARLINK-1008";
  t.given = time;
  t.start = {time.ns + std::int64_t(n.in(1e9, 1e10))};
  t.on_target = {t.start.ns + std::int64_t(n.in(1e9, 1e10))};
  t.end = {t.on_target.ns + std::int64_t(n.in(1e9, 1e10))};
  t.first_frame = 12, t.exposures = 3;
  t.path_start = {t.start.ns - 1};
  t.path_step_s = n.in(1, 20);
  for (int i = 0; i < 9; ++i) {
    t.path_m.push_back(n.in(-4e7, 4e7));
    t.path_m_per_s.push_back(n.in(-8e3, 8e3));
  }
  for (double& c : t.covariance) c = n.in(0, 1e6);
  t.sigma_rad = n.in(0, 1e-3);
  t.slew_rad = n.in(0, 3), t.slew_s = n.in(1, 20);
  t.in_field = n.in(0, 1), t.detection_probability = n.in(0, 1);
  t.gain_nats = n.in(0, 20), t.gain_nats_per_s = n.in(0, 2);
  t.candidates = 31, t.runner_up = 9, t.runner_up_nats_per_s = n.in(0, 1);
  return t;
}

}  // namespace

std::vector<Example> examples(unsigned seed) {
  Numbers n(seed);
  const Tick tick = Tick(seed % 24) + 1;
  DetectionSet detections{.sensor = sensor, .frame = 3, .detections = {}};
  for (std::uint32_t i = 0; i < 4; ++i) detections.detections.push_back(detection(n, i));
  TruthSet truths{.sensor = sensor, .frame = 3, .truths = {truth(n), truth(n)}};
  const SimTime time = example_run().time_of(tick);
  TrackSet tracks{.tick = tick, .time = time, .node = "fusion-node", .live = 30, .unassociated = 4};
  for (std::uint32_t id = 1; id < 5; ++id) tracks.tracks.push_back(track(n, id, time));
  TaskSet tasks{.tick = tick, .time = time, .node = "fusion-node", .sensor = sensor, .tasks = {}};
  for (std::uint32_t id = 3; id < 5; ++id) tasks.tasks.push_back(task(n, id, time));
  const ObjectRoster objects = roster(n);
  return {{objects_topic, tick, objects},
          {objects_topic, tick, states(n, tick)},
          {environment_topic, tick, environment(n, tick)},
          {std::string(site_prefix) + sensor, tick, site(n, tick)},
          {std::string(frame_prefix) + sensor, tick, report(n)},
          {std::string(detection_prefix) + sensor, tick, detections},
          {std::string(detection_prefix) + sensor, tick, DetectionSet{sensor, 4, {}}},
          {std::string(truth_prefix) + sensor, tick, truths},
          {std::string(track_prefix) + "fusion-node", tick, tracks},
          {std::string(task_prefix) + sensor, tick, tasks},
          {objects_topic, tick,
           ObjectStates{.tick = tick, .time = example_run().time_of(tick), .count = 0}},
          {roster_topic, tick, objects}};
}

Envelope envelope_of(const Example& example, MessageKind kind, std::uint64_t sequence) {
  return {.run_id = example_run().run_id,
          .publisher = "source",
          .sequence = sequence,
          .kind = kind,
          .tick = example.tick,
          .time = example_run().time_of(example.tick),
          .last_of_tick = true};
}

Frames sealed(const Example& example, std::uint64_t sequence) {
  Encoded body = encode(example.state);
  return seal(example.topic, envelope_of(example, body.kind, sequence), std::move(body.payload),
              std::move(body.arrays));
}

Receiver receiver_of_examples() {
  Receiver receiver(example_run());
  for (const std::string& topic :
       {std::string(roster_topic), std::string(objects_topic), std::string(environment_topic),
        std::string(actor_prefix) + "gnc", std::string(site_prefix) + sensor,
        std::string(frame_prefix) + sensor, std::string(detection_prefix) + sensor,
        std::string(truth_prefix) + sensor, std::string(track_prefix) + "fusion-node",
        std::string(task_prefix) + sensor})
    receiver.allow(topic, "source", 1);
  return receiver;
}

}  // namespace dmise::test
