#include "core/base/units.h"
#include "tests/pipeline/wiring.h"

namespace dmise {
namespace {

const std::string iss =
    "ISS\n"
    "1 25544U 98067A   18020.89808844  .00002078  00000-0  38550-4 0  9992\n"
    "2 25544  51.6424  32.9776 0003646  28.7227  39.5332 15.54190080 95614\n";

/// The ISS over a fisheye in the southern Pacific, mid exposure 2018-01-21T00:15:05Z.
std::string scene(const std::string& effects) {
  return test::scenario(
      "2018-01-21T00:15:00Z", 20, "site: {latitude_deg: -23, longitude_deg: -106, height_m: 100}",
      "{optics: {projection: equidistant, columns: 600, rows: 600, pixel_pitch_m: "
      "1.0e-5, field_of_view_deg: 180, aperture_m: 0.002}, detector: {full_well_e: "
      "1.0e+9, gain_e_per_dn: 1}, band: {filter: bessell-V}}",
      "zenith", 4, 10, ", first_exposure_s: 3, effects: {" + test::noiseless + effects + "}", "",
      "objects: [{catalogue: objects.tle, radius_m: 20, albedo: 0.3}]\n");
}

FrameProducts pass(const std::string& effects = "") {
  test::Stage stage(scene(effects), "", iss);
  return stage.frame();
}

// Reference: skyfield's (satellite - site).at(t), the Sun by ERFA, and the diffuse sphere's
// magnitude, by tests/reference/wiring.py. Over a geocentric horizon the elevation would be 0.138
// deg higher.
TEST(Truth, HasTheElevationPhaseAndMagnitudeThatSkyfieldSees) {
  const auto frame = pass();
  ASSERT_EQ(frame.truths.size(), 1u);
  const auto& truth = frame.truths[0];
  EXPECT_NEAR(truth.true_elevation_rad / deg, 31.095066, 2e-4);
  EXPECT_NEAR(truth.true_range_m, 732545.4, 3.0);
  EXPECT_NEAR(truth.phase_angle_rad / deg, 91.424904, 1e-3);
  EXPECT_NEAR(truth.true_magnitude, -0.94260, 1e-3);
}

// Reference: skyfield's iss.at(t), by tests/reference/wiring.py. SGP4's own velocity, which
// skyfield gives, is not quite the slope of its positions.
TEST(Truth, HasTheStateThatSkyfieldHas) {
  const auto truth = pass().truths.at(0);
  const Vec<Gcrs> position_m{6158911.52, 1962665.58, -2058129.46};
  const Vec<Gcrs> velocity_m_per_s{163.8299, 5285.1399, 5552.368};
  EXPECT_LT(norm(truth.true_position_m - position_m), 3.0);
  EXPECT_LT(norm(truth.true_velocity_m_per_s - velocity_m_per_s), 0.03);
}

// Reference: skyfield's places, one light time earlier for the apparent one, then ERFA's eraAb by
// the site's motion, by tests/reference/wiring.py: 4.0 arcsec apart.
TEST(Truth, HasThePlacesThatSkyfieldSees) {
  const auto geometric = pass(", light_time: off").truths.at(0), truth = pass().truths.at(0);
  const Vec<Gcrs> skyfield = from_spherical<Gcrs>(15.698192 * deg, 35.775003 * deg);
  const Vec<Gcrs> apparent = from_spherical<Gcrs>(15.697105 * deg, 35.774321 * deg);
  const auto astrometric_of = [](const Truth& t) {
    return from_spherical<Gcrs>(t.true_ra_rad, t.true_dec_rad);
  };
  const auto apparent_of = [](const Truth& t) {
    return from_spherical<Gcrs>(t.apparent_ra_rad, t.apparent_dec_rad);
  };
  EXPECT_LT(angle_rad(astrometric_of(geometric), skyfield), 0.2 * arcsec);
  EXPECT_LT(angle_rad(apparent_of(truth), apparent), 0.2 * arcsec);
  EXPECT_NEAR(angle_rad(astrometric_of(truth), apparent_of(truth)) / arcsec, 0.3, 0.1);
}

// The label lies where the camera has the apparent place, at the time that it names.
TEST(Truth, HasItsLabelWhereTheCameraHasItsPlace) {
  test::Stage stage(scene(", refraction: off"), "", iss);
  const auto frame = stage.frame();
  const auto& truth = frame.truths.at(0);
  const auto& sensor = stage.scenario.sensors[0];
  const View view(sensor, frame_times(sensor, 1), stage.states);
  // Skyfield's apparent place, in the fisheye: 0.001 px are 1.1 arcsec.
  const auto at =
      test::pixel_of(view, from_spherical<Gcrs>(15.697105 * deg, 35.774321 * deg), truth.middle);
  ASSERT_TRUE(at);
  EXPECT_NEAR(truth.middle_x_px, at->x_px, 0.001);
  EXPECT_NEAR(truth.middle_y_px, at->y_px, 0.001);
  const auto direction_at = [&](SimTime t) {
    const auto motion = stage.states.motion(0, t);
    return view.places(t).satellite(motion.position_m, motion.slope_m_per_s).direction;
  };
  const auto end = test::pixel_of(view, direction_at(truth.end), truth.end);
  EXPECT_NEAR(truth.end_x_px, end->x_px, 1e-6);
  EXPECT_NEAR(truth.end_y_px, end->y_px, 1e-6);
  EXPECT_GT(std::hypot(truth.end_x_px - truth.middle_x_px, truth.end_y_px - truth.middle_y_px),
            1.0);
}

}  // namespace
}  // namespace dmise
