#include <algorithm>
#include <cmath>

#include "core/base/files/json_record.h"
#include "core/base/units.h"
#include "core/image/fits_cards.h"
#include "core/image/fits_file.h"
#include "core/products/frame_report.h"
#include "core/products/product_json.h"
#include "sensors/scene/bodies_in_field.h"
#include "sensors/scene/exclusion.h"
#include "tests/pipeline/body_scenes.h"
#include "tests/support/detect_frame.h"

// Angles of Sun, Moon and limb from a camera's axis, and what happens in frames within them.
namespace dmise::test {
namespace {

const std::string huntsville = "site: {latitude_deg: 34.73, longitude_deg: -86.58, height_m: 190}";

std::string with(const std::string& camera, const std::string& exclusion) {
  return camera.substr(0, camera.size() - 1) + ", exclusion: {" + exclusion + "}}";
}

BodyAngles angles_of(const Stage& stage, const Exclusion& exclusion, std::uint32_t frame = 1) {
  SensorConfig sensor = stage.scenario.sensors[0];
  sensor.camera.exclusion = exclusion;
  return body_angles(View(sensor, frame_times(sensor, frame), stage.states));
}
Excluded excluded(const Stage& stage, const Exclusion& exclusion) {
  SensorConfig sensor = stage.scenario.sensors[0];
  sensor.camera.exclusion = exclusion;
  return View(sensor, frame_times(sensor, 1), stage.states).excluded();
}
Exclusion sun(double deg) { return {.sun_deg = deg, .moon_deg = {}, .earth_limb_deg = {}}; }
Exclusion moon(double deg) { return {.sun_deg = {}, .moon_deg = deg, .earth_limb_deg = {}}; }
Exclusion limb(double deg) { return {.sun_deg = {}, .moon_deg = {}, .earth_limb_deg = deg}; }

/// A direction at an angle from another.
Vec<Gcrs> beside(const Vec<Gcrs>& direction, double angle_rad) {
  const Vec<Gcrs> aside = unit(cross(direction, Vec<Gcrs>{0, 0, 1}));
  return direction * std::cos(angle_rad) + aside * std::sin(angle_rad);
}

// Reference: astropy 5.2 (tests/reference/body_angles.py): right ascension, declination and
// altitude of the Sun, then of the Moon, seen from the site or from [4.2e7, 1e6, 2e6] m.
struct BodyRow {
  const char* time;
  bool site;
  double sun_ra_deg, sun_dec_deg, sun_altitude_deg, moon_ra_deg, moon_dec_deg, moon_altitude_deg;
};
constexpr BodyRow rows[] = {
    {"2018-01-02T06:00:00Z", true, 282.5387491, -22.9369472, -77.9923287, 104.5490139, 19.7747247,
     75.0125838},
    {"2018-01-02T06:00:00Z", false, 282.5213025, -22.9383995, 90, 111.3230533, 19.1014839, 90},
    {"2018-04-11T15:00:00Z", true, 19.7939533, 8.3494119, 43.5797963, 330.4331833, -14.1819069,
     40.6560577},
    {"2018-04-11T15:00:00Z", false, 19.7976780, 8.3520215, 90, 327.0171057, -15.1035188, 90},
    {"2018-07-19T18:30:00Z", true, 118.8157081, 20.7975992, 73.7778778, 206.8582613, -5.7586729,
     5.8807109},
    {"2018-07-19T18:30:00Z", false, 118.8310005, 20.7948809, 90, 203.7012648, -5.0029772, 90},
    {"2018-10-30T12:00:00Z", true, 214.4163050, -13.7676613, -1.8433469, 112.4091165, 20.7230178,
     67.8241867},
    {"2018-10-30T12:00:00Z", false, 214.4051333, -13.7637774, 90, 118.8791732, 19.7748184, 90}};

// The boundary lies within 1.8 arcsec of where astropy has it.
TEST(Exclusion, OfSunAndMoonBeginsWhereAstropyHasIt) {
  for (const BodyRow& row : rows)
    for (const bool is_sun : {true, false}) {
      const auto body = from_spherical<Gcrs>((is_sun ? row.sun_ra_deg : row.moon_ra_deg) * deg,
                                             (is_sun ? row.sun_dec_deg : row.moon_dec_deg) * deg);
      const bool is_up = (is_sun ? row.sun_altitude_deg : row.moon_altitude_deg) > -0.3;
      const double angle_deg = is_sun ? 40.0 : 10.0, slack_deg = 5e-4;
      const std::string pointing = towards(beside(body, angle_deg * deg));
      Stage stage(
          row.site ? scenario(row.time, 5, huntsville, camera(8, 8, 0.1), pointing, 0.01, 5,
                              more(", refraction: off"))
                   : in_space({42e6, 1e6, 2e6}, pointing, camera(8, 8, 0.1), "", "", "", row.time));
      const auto is_excluded = [&](double limit_deg) {
        const Excluded e = excluded(stage, is_sun ? sun(limit_deg) : moon(limit_deg));
        EXPECT_FALSE(is_sun ? e.moon : e.sun);
        return is_sun ? e.sun : e.moon;
      };
      EXPECT_EQ(is_excluded(angle_deg + slack_deg), is_up) << row.time << row.site << is_sun;
      EXPECT_FALSE(is_excluded(angle_deg - slack_deg)) << row.time << row.site << is_sun;
    }
}

TEST(Exclusion, ExactlyAtTheAngleIsNotNearer) {
  const BodyAngles at{.sun_rad = 40.0 * deg, .moon_rad = 10.0 * deg, .earth_limb_rad = 20.0 * deg};
  Exclusion limits{.sun_deg = 40.0, .moon_deg = 10.0, .earth_limb_deg = 20.0};
  EXPECT_EQ(excluded_by(limits, at), Excluded());
  limits = {.sun_deg = std::nextafter(40.0, 41.0),
            .moon_deg = std::nextafter(10.0, 11.0),
            .earth_limb_deg = std::nextafter(20.0, 21.0)};
  EXPECT_EQ(excluded_by(limits, at), (Excluded{true, true, true}));
  EXPECT_EQ(excluded_by(limits, {}), Excluded());       // all hidden
  EXPECT_EQ(excluded_by(Exclusion(), at), Excluded());  // no limits
}

// With the Sun in the middle of the field: 0 excludes nothing, any more does; 180 all but the
// opposite point.
TEST(Exclusion, OfZeroIsNoneAndOf180IsEverywhere) {
  const Vec<Gcrs> at_m = unit(bodies().sun_m) * 4e7;
  Stage at_sun(in_space(at_m, towards(bodies().sun_m - at_m), camera(8, 8, 0.1)));
  EXPECT_FALSE(excluded(at_sun, sun(0.0)).any());
  EXPECT_TRUE(excluded(at_sun, sun(0.01)).sun);  // aberration is 0.006 deg
  EXPECT_LT(*angles_of(at_sun, sun(1.0)).sun_rad, 0.006 * deg);
  EXPECT_TRUE(excluded(at_sun, sun(180.0)).sun);
  Stage away(in_space(at_m, towards(at_m - bodies().sun_m), camera(8, 8, 0.1)));
  EXPECT_TRUE(excluded(away, sun(180.0)).sun);
  EXPECT_FALSE(excluded(away, sun(179.9)).sun);
  EXPECT_EQ(excluded_by(sun(180.0), {.sun_rad = pi, .moon_rad = {}, .earth_limb_rad = {}}),
            Excluded());
}

/// A camera that turns about the celestial pole, 3 deg from the Sun at the nearest, `after_s`.
std::string turning_past_sun(double exposure_s, double after_s, double rate_deg_per_s,
                             const std::string& detector = "") {
  const Vec<Gcrs> at_m = unit(bodies().sun_m) * 4e7;
  const auto [ra, dec] = to_spherical(bodies().sun_m - at_m);
  char text[400];
  std::snprintf(text, sizeof text,
                "{scan: {ra_deg: %.9f, dec_deg: %.9f, axis: [0, 0, 1], rate_deg_per_s: %.9f}}",
                ra / deg - rate_deg_per_s * after_s, dec / deg + 3.0, rate_deg_per_s);
  char platform[160];
  std::snprintf(platform, sizeof platform,
                "objects:\n  - name: platform\n    motion: {fixed: {gcrs_m: [%.3f, %.3f, %.3f]}}\n",
                at_m.x, at_m.y, at_m.z);
  return scenario("2018-01-21T00:15:00Z", 20, "platform: platform",
                  camera(64, 64, 0.1, detector, ", aperture_m: 0.02"), text, exposure_s, 20,
                  more(", annual_aberration: off, light_time: off"), "", platform);
}

// On a parallel of declination 3 deg from the Sun's: nearest where the right ascensions are equal,
// at 3.4 s of 10 s; the angles at begin, middle and end are larger.
TEST(Exclusion, IsByTheLeastAngleOfATurnPastTheSun) {
  for (const double rate_deg_per_s : {-0.9, 0.5, 0.9}) {
    Stage stage(turning_past_sun(10.0, 3.4, rate_deg_per_s));
    const double min_rad = *angles_of(stage, sun(40.0)).sun_rad;
    EXPECT_NEAR(min_rad / deg, 3.0, 2e-4) << rate_deg_per_s;  // the place moves in the Sun's way
    EXPECT_TRUE(excluded(stage, sun(3.001)).sun);
    EXPECT_FALSE(excluded(stage, sun(2.999)).sun);
    const auto& sensor = stage.scenario.sensors[0];
    const View view(sensor, frame_times(sensor, 1), stage.states);
    for (const SimTime t : {view.times().start, view.times().middle, view.times().end})
      EXPECT_GT(angle_rad(view.camera_from_gcrs(t).inverse() * Vec<CameraFrame>{0, 0, 1},
                          truly_seen_sun(view, t).apparent),
                min_rad + 0.02 * deg);
  }
}

// The axis is 70 deg from that of the spin, which is 50 deg from the Sun: 20 deg at the nearest, in
// 1.5 to 1000 turns of an exposure.
TEST(Exclusion, IsByTheLeastAngleOfACameraThatSpins) {
  const Vec<Gcrs> at_m = unit(bodies().sun_m) * 4e7, to_sun = unit(bodies().sun_m - at_m);
  const Vec<Gcrs> spin = beside(to_sun, 50.0 * deg);
  for (const double rpm : {9.0, 18.0, 600.0, 6000.0}) {
    char objects[400];
    std::snprintf(
        objects, sizeof objects,
        "objects:\n  - name: platform\n    motion: {fixed: {gcrs_m: [%.3f, %.3f, %.3f]}}\n"
        "    attitude: {spinning: {axis: [%.15f, %.15f, %.15f], rate_rpm: %g, phase_deg: "
        "12.3}}\n",
        at_m.x, at_m.y, at_m.z, spin.x, spin.y, spin.z, rpm);
    const Vec<Gcrs> boresight = beside(spin, 70.0 * deg);
    char pointing[160];
    std::snprintf(pointing, sizeof pointing, "{body: {boresight: [%.15f, %.15f, %.15f]}}",
                  boresight.x, boresight.y, boresight.z);
    Stage stage(scenario("2018-01-21T00:15:00Z", 20, "platform: platform", camera(8, 8, 0.1),
                         pointing, 10.0, 20, more(", annual_aberration: off, light_time: off"), "",
                         objects));
    EXPECT_NEAR(*angles_of(stage, sun(40.0)).sun_rad / deg, 20.0, 2e-4) << rpm;
  }
}

// Rows of a rolling shutter that are exposed later count: here the last ones alone are near.
TEST(Exclusion, OfARollingShutterIsThatOfAllRows) {
  const std::string rolling = "full_well_e: 1.0e+9, gain_e_per_dn: 1, row_time_us: 100000";
  Stage at_once(turning_past_sun(0.1, 6.0, 0.9)), rolled(turning_past_sun(0.1, 6.0, 0.9, rolling));
  EXPECT_NEAR(*angles_of(rolled, sun(40.0)).sun_rad / deg, 3.0, 2e-4);
  EXPECT_TRUE(excluded(rolled, sun(3.01)).sun);
  EXPECT_GT(*angles_of(at_once, sun(40.0)).sun_rad / deg, 5.0);
  EXPECT_FALSE(excluded(at_once, sun(3.01)).sun);
}

// Behind the Earth the Sun excludes nothing, however near the axis; beside the shadow it does.
TEST(Exclusion, OfASunBehindTheEarthIsNone) {
  const Vec<Gcrs> to_sun = unit(bodies().sun_m), night_m = to_sun * -6900e3;
  const Vec<Gcrs> aside = unit(cross(to_sun, Vec<Gcrs>{0, 0, 1}));
  Stage dark(in_space(night_m, towards(to_sun), camera(8, 8, 0.1)));
  EXPECT_FALSE(excluded(dark, sun(40.0)).any());
  EXPECT_FALSE(angles_of(dark, sun(40.0)).sun_rad.has_value());
  Stage lit(in_space(night_m + aside * 6500e3, towards(to_sun), camera(8, 8, 0.1)));
  EXPECT_TRUE(excluded(lit, sun(40.0)).sun);
  // In the penumbra, 6378.1 km (1 - f sin2) and 31 km of it, part of the disc is seen.
  const double limb_m = 6378137.0 * std::sqrt(1 - 0.0067 * std::pow(aside.z, 2));
  Stage penumbra(in_space(night_m + aside * limb_m, towards(to_sun), camera(8, 8, 0.1)));
  EXPECT_TRUE(excluded(penumbra, sun(40.0)).sun);
}

// 2.9 deg from the Sun (a phase angle of 177.1 deg), dark towards us: it excludes as a full one.
TEST(Exclusion, OfANewMoonIsThatOfAFullOne) {
  Stage stage(scenario("2018-01-16T22:30:00Z", 5, huntsville, camera(8, 8, 0.1),
                       radec(295.6299818, -19.9625799 + 5.0), 0.01, 5, more()));
  EXPECT_TRUE(excluded(stage, moon(10.0)).moon);
  EXPECT_FALSE(excluded(stage, moon(4.0)).moon);
}

// A camera off its commanded axis by 5 deg: what counts is where it truly looks.
TEST(Exclusion, IsOfTheTrueAxis) {
  const Vec<Gcrs> at_m = unit(bodies().sun_m) * 4e7, to_sun = unit(bodies().sun_m - at_m);
  const auto yaml = [&](const char* bias) {
    std::string text = in_space(at_m, towards(beside(to_sun, 40.0 * deg)), camera(8, 8, 0.1));
    const auto at = text.find(", sky: dark");
    return text.insert(at, std::string(", pointing_error: {bias_deg: ") + bias + "}");
  };
  Stage plus(yaml("[5, 0, 0]")), minus(yaml("[-5, 0, 0]")), across(yaml("[0, 5, 0]")),
      back(yaml("[0, -5, 0]"));
  std::vector<double> angles;
  for (const Stage* stage : {&plus, &minus, &across, &back})
    angles.push_back(*angles_of(*stage, sun(40.0)).sun_rad / deg);
  std::ranges::sort(angles);
  EXPECT_NEAR(angles.front(), 35.0, 0.2);
  EXPECT_NEAR(angles.back(), 45.0, 0.2);
}

// Spheres: the limb is asin(R / r) from the nadir.
TEST(Exclusion, OfTheLimbIsByItsClosedForm) {
  const double distance_m = 6378137.0 + 550e3;
  const std::string sphere = ", ellipsoid: {a_m: 6378137, f: 0}";
  for (const double from_nadir_deg : {30.0, 70.0, 90.0, 120.0, 180.0}) {
    const double a = from_nadir_deg * deg;
    const Vec<Gcrs> axis{-std::cos(a), std::sin(a) * 0.6, std::sin(a) * 0.8};
    Stage stage(in_space({distance_m, 0, 0}, towards(axis), camera(8, 8, 0.1), "", "", sphere));
    const double expected_deg = from_nadir_deg - std::asin(6378137.0 / distance_m) / deg;
    EXPECT_NEAR(*angles_of(stage, limb(20.0)).earth_limb_rad / deg, expected_deg, 1e-5)
        << from_nadir_deg;
    EXPECT_EQ(excluded(stage, limb(20.0)).earth_limb, expected_deg < 20.0);
  }
}

// ---- frames -----------------------------------------------------------------------------------

/// A thing 100 km before a camera that looks at stars, in sunlight; with noise and detection.
std::string with_thing(const std::string& exclusion, const std::string& light = "",
                       const std::string& end = "") {
  const std::string plain = camera(96, 96, 0.1,
                                   "full_well_e: 1.0e+5, gain_e_per_dn: 2, "
                                   "dark_e_per_s: 5, read_noise_e: 4");
  return scenario("2018-01-21T00:15:00Z", 20, "platform: eye",
                  exclusion.empty() ? plain : with(plain, exclusion), "{ra_deg: 270, dec_deg: 60}",
                  2, 5, ", sky: dark" + light, "",
                  "objects:\n"
                  "  - name: eye\n    motion: {fixed: {gcrs_m: [4.2e7, 1e6, 2e6]}}\n"
                  "  - name: thing\n    radius_m: 3\n"
                  "    motion: {fixed: {gcrs_m: [4.2e7, 950100, 2086602]}}\n" +
                      with_stars) +
         end;
}
const std::string catalogue = "ra_deg,dec_deg,mag_v,bv\n270.3,60.2,5,0.6\n269,59.5,6,0.6\n";

const std::string no_light =
    ", effects: {sky: off, stars: off, objects: off, sun_disc: off, moon_disc: off, earth_disc: "
    "off, shadow: off}";
const std::string closing = "sun_deg: 180, action: close_shutter";

// By the same draws of noise as those of a sensor that has no light to see.
TEST(ClosedShutter, LeavesTheCountsOfADetectorInTheDark) {
  Stage closed(with_thing(closing), catalogue), unlit(with_thing("", no_light), catalogue),
      open(with_thing(""), catalogue);
  const FrameProducts frame = closed.frame(), seen = open.frame();
  EXPECT_EQ(frame.counts.pixels, unlit.frame().counts.pixels);
  EXPECT_NE(frame.counts.pixels, seen.counts.pixels);
  ASSERT_EQ(seen.truths.size(), 1u);
  EXPECT_TRUE(seen.truths[0].in_frame);
  ASSERT_EQ(frame.truths.size(), 1u);  // it is where it is, without light
  EXPECT_FALSE(frame.truths[0].in_frame);
  EXPECT_EQ(frame.truths[0].rendered_signal_e, 0.0);
  EXPECT_EQ(frame.truths[0].middle_x_px, seen.truths[0].middle_x_px);
  EXPECT_EQ(frame.truths[0].true_magnitude, seen.truths[0].true_magnitude);
  const auto utc = [](SimTime) { return std::string("2018-01-21T00:15:00Z"); };
  EXPECT_NE(to_json(frame.truths[0], utc).find("\"rendered_px\":null"), std::string::npos);
  EXPECT_TRUE(frame.stars.empty());
  EXPECT_EQ(frame.report.stars_rendered, 0u);
  EXPECT_EQ(frame.report.objects_rendered, 0u);
}

TEST(ClosedShutter, IsToldByReportHeaderAndDetection) {
  Stage closed(with_thing(closing + ", moon_deg: 0"), catalogue);
  const FrameProducts frame = closed.frame();
  EXPECT_TRUE(frame.report.shutter_closed && frame.report.detection_off);
  EXPECT_EQ(frame.report.excluded, (Excluded{true, false, false}));
  EXPECT_TRUE(frame.detections.empty());
  EXPECT_EQ(frame.report.plan.find("stars"), std::string::npos) << frame.report.plan;
  EXPECT_NE(frame.report.plan.find("read_noise"), std::string::npos);
  const std::string path = (closed.directory / "frame.fits").string();
  write_frame(path, frame.counts, frame.header);
  const Frame read = read_frame(path);
  EXPECT_EQ(read.header, as_in_file(frame.header));
  EXPECT_TRUE(read.header.shutter_closed());
  EXPECT_EQ(read.header.exclusion, closed.scenario.sensors[0].camera.exclusion);
  Threads threads(2);
  const DetectionLines found = test::detect_frame(read, threads);
  EXPECT_TRUE(found.lines.empty());
  const JsonRecord report(found.report, "report");
  for (const char* key : {"shutter_closed", "sun_excludes", "detection_off"})
    EXPECT_TRUE(report.get<bool>(key)) << key;
  EXPECT_FALSE(report.has("moon_excludes"));
}

TEST(FlaggedExclusion, LeavesTheFrameAsItIs) {
  Stage flagged(with_thing("sun_deg: 180"), catalogue), plain(with_thing(""), catalogue),
      unused(with_thing("sun_deg: 1"), catalogue);
  const FrameProducts frame = flagged.frame(), without = plain.frame(), far = unused.frame();
  EXPECT_EQ(frame.counts.pixels, without.counts.pixels);
  EXPECT_EQ(frame.truths, without.truths);
  ASSERT_EQ(frame.detections.size(), 1u);
  Detection d = frame.detections[0];
  EXPECT_TRUE(d.excluded);
  d.excluded = false;
  EXPECT_EQ(d, without.detections.at(0));
  EXPECT_EQ(far.detections, without.detections);
  EXPECT_TRUE(frame.report.excluded.sun);
  EXPECT_FALSE(frame.report.shutter_closed || frame.report.detection_off);
  FrameReport report = frame.report;
  report.excluded = {};
  EXPECT_EQ(report, without.report);
  EXPECT_EQ(far.report, without.report);
  // And a sensor without has no cards of it.
  const auto cards = fits_cards(without.header), more_cards = fits_cards(frame.header);
  const auto has = [](const std::vector<std::string>& all, const char* key) {
    return std::ranges::any_of(all, [&](const auto& card) { return card.starts_with(key); });
  };
  for (const char* key : {"SUNEXCL ", "SUNNEAR ", "EXCLACT ", "SHUTTER "}) {
    EXPECT_TRUE(has(more_cards, key)) << key;
    EXPECT_FALSE(has(cards, key)) << key;
  }
  EXPECT_EQ(more_cards.size(), cards.size() + 4);
}

// The Sun in the field blinds an open camera; behind a closed shutter there is nothing of it.
TEST(ClosedShutter, HidesASunInTheField) {
  const Vec<Gcrs> at_m = unit(bodies().sun_m) * 4e7;
  const std::string to_sun = towards(bodies().sun_m - at_m);
  Stage open(in_space(at_m, to_sun, camera(96, 96, 0.1)));
  Stage closed(in_space(at_m, to_sun, with(camera(96, 96, 0.1), closing)));
  EXPECT_GT(sum_of(light_of(open)), 0.0);
  EXPECT_EQ(sum_of(light_of(closed)), 0.0);
  EXPECT_EQ(closed.frame().report.plan.find("sun_disc"), std::string::npos);
}

// Nothing is planned of light that does not come in, and the plan is that of any run.
TEST(ClosedShutter, IsPlannedForItsDetectorAlone) {
  Stage closed(with_thing(closing, "", "accuracy: standard\n"), catalogue);
  const FrameProducts frame = closed.frame();
  EXPECT_FALSE(frame.plan.planned.empty());
  for (const PlannedEffect& p : frame.plan.planned)
    for (const std::string_view light : {"stars", "objects", "sky", "psf", "light_time"})
      EXPECT_NE(p.facts->name, light);
  EXPECT_TRUE(frame.report.shutter_closed);
  EXPECT_EQ(frame.truths.size(), 1u);
}

TEST(ClosedShutter, IsTheSameForAnyNumberOfThreads) {
  Stage stage(with_thing(closing), catalogue);
  expect_same_by_threads(stage, {2, 3});
}

}  // namespace
}  // namespace dmise::test
