#include "sensors/scene/throughput.h"

#include <cmath>
#include <map>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/sky/sky_model.h"
#include "core/sky/surface_brightness.h"
#include "sensors/frame/frame_planes.h"
#include "sensors/light/sky_layer.h"
#include "tests/pipeline/wiring.h"
#include "tests/support/directions.h"

namespace dmise {
namespace {

const std::string mountain = "site: {latitude_deg: -30.2, longitude_deg: -70.7, height_m: 2000}";

// Reference: Young 1967 (Osborn et al. 2015, equation 7), airmass 1.994 at 30 deg (Kasten & Young
// 1989, table): sigma^2 = 10e-6 D^(-4/3) / t X^3 exp(-2 h / 8 km).
TEST(LightOfARun, FlickersByYoungsLawAtSixtyDegreesFromTheZenith) {
  test::Stage stage(test::scenario("2018-03-06T12:00:00Z", 20, mountain,
                                   test::camera(8, 8, 0.5, "", ", aperture_m: 0.02"), "zenith", 0.1,
                                   5));
  const auto& sensor = stage.scenario.sensors[0];
  const View view(sensor, frame_times(sensor, 1), stage.states);
  const Throughput throughput(view);
  const auto* scintillation = throughput.find<Scintillation>();
  const Vec<Gcrs> at = test::direction(view, 2.0, 30 * deg);
  const double sigma = std::sqrt(10e-6 * std::pow(0.02, -4.0 / 3) / 0.1 * std::pow(1.994, 3) *
                                 std::exp(-2 * 2000.0 / 8000));
  for (const auto what : {SightLine::Source::star, SightLine::Source::object}) {
    constexpr int count = 40000;
    double sum = 0, squares = 0;
    for (std::uint32_t i = 1; i <= count; ++i) {
      const double f = scintillation->apply({at, sun_bv, what, i});
      sum += f;
      squares += f * f;
    }
    const double mean = sum / count;
    EXPECT_NEAR(mean, 1.0, 5 * sigma / std::sqrt(count));
    EXPECT_NEAR(std::sqrt(squares / count - mean * mean) / sigma, 1.0, 0.02);
  }
  const View next(sensor, frame_times(sensor, 2), stage.states);
  const SightLine star{at, sun_bv, SightLine::Source::star, 1};
  EXPECT_GT(
      std::abs(Throughput(next).find<Scintillation>()->apply(star) - scintillation->apply(star)),
      1e-3 * sigma);  // each frame draws anew
}

// A satellite that is seen at 5 deg, lifted by 9.8 arcmin. Reference: the relative airmass of
// Kasten & Young 1989, table, at the apparent altitude: 10.32 (10.58 at the geometric one).
TEST(LightOfARun, ASatellitesExtinctionIsThatOfItsApparentAltitude) {
  const auto scene = [](const std::string& objects) {
    return test::scenario("2018-03-06T12:00:00Z", 20, "site: atlanta", test::camera(256, 256, 0.05),
                          "{azimuth_deg: 180, elevation_deg: 5}", 1, 5,
                          ", atmosphere: {extinction: 0.2}, effects: {" + test::noiseless +
                              ", shadow: off, light_time: off, diurnal_aberration: off}",
                          "", "objects:\n" + objects);
  };
  const auto object = [](double x, double y, double z) {
    char text[200];
    std::snprintf(text, sizeof text,
                  "  - name: target\n    motion: {fixed: {gcrs_m: [%.3f, %.3f, %.3f]}}\n    "
                  "radius_m: 30\n",
                  x, y, z);
    return std::string(text);
  };
  test::Stage empty(scene(object(4e7, 0, 0)));
  const auto& sensor = empty.scenario.sensors[0];
  const View view(sensor, frame_times(sensor, 1), empty.states);
  // Straight line to it: the mean refraction at an apparent 5 deg (The Explanatory Supplement to
  // the Astronomical Almanac, 3.283: 9.9 arcmin at 1010 hPa and 10 deg C), by the air here.
  const double lift_rad = 9.9 * arcmin * (977.7 / 1010) * (283.15 / 286.2);
  const Vec<Gcrs> at = view.observer(view.times().middle).position_m +
                       test::direction(view, 180 * deg, 5 * deg - lift_rad) * 3.6e7;
  test::Stage stage(scene(object(at.x, at.y, at.z)));
  const auto frame = stage.frame();
  ASSERT_EQ(frame.truths.size(), 1u);
  const auto& truth = frame.truths[0];
  const double above_air_e = frame.header.exposure_s *
                             light_of_magnitude(truth.true_magnitude - frame.header.zero_point_mag);
  const double k = frame.header.extinction_mag_per_airmass;
  EXPECT_NEAR(k, 0.2, 0.002);
  EXPECT_NEAR(magnitude_of_light(truth.rendered_signal_e / above_air_e) / k, 10.32, 0.06);
  // It lies where the camera looks: lifted into the middle (1 arcmin is 1.45 px).
  EXPECT_NEAR(truth.rendered_x_px, 127.5, 0.1);
  EXPECT_NEAR(truth.rendered_y_px, 127.5, 0.7);
}

/// Camera with the cosine of the pupil's foreshortening, 30 deg from the boresight in its corners'
/// direction along the columns.
const std::string foreshortened =
    test::camera(441, 21, 0.0035, "", ", aperture_m: 0.001, vignetting: {natural: true}");

std::string uniform_sky(const std::string& camera, const std::string& effects = "") {
  return test::scenario("2018-03-06T03:00:00Z", 20, "site: atlanta", camera, "zenith", 1, 5,
                        ", sky: 18, effects: {photon_noise: off, dark_current: off, read_noise: "
                        "off, full_well: off, extinction: off, scintillation: off" +
                            effects + "}");
}

/// The sky's fall from the centre to 30 deg off it, and the cosine of that pixel's angle.
std::pair<double, double> fall_at_30_deg(const std::string& effects) {
  test::Stage stage(uniform_sky(foreshortened, effects));
  const auto& sensor = stage.scenario.sensors[0];
  const View view(sensor, frame_times(sensor, 1), stage.states);
  ExpectedElectronImage image(441, 21);
  fill_sky(view, {9.0}, image, stage.threads);
  const int x = int(std::lround(220 + 350 * std::tan(30 * deg)));
  return {image.at(x, 10) / image.at(220, 10), std::cos(std::atan((x - 220) / 350.0))};
}

// Reference: the cosine-fourth law (gnomonic lens): cos^4 30 deg = 0.5625.
TEST(LightOfARun, AUniformSkyFallsOffByTheCosineFourthLaw) {
  const auto [fall, cosine] = fall_at_30_deg("");
  EXPECT_NEAR(std::pow(cosine, 4), 0.5625, 0.001);
  EXPECT_NEAR(fall, std::pow(cosine, 4), 0.004);
}

// Without vignetting what is left of the law is the solid angle of a gnomonic lens's pixels, cos^3.
TEST(LightOfARun, WithoutVignettingAUniformSkyFallsOffByTheSolidAngleAlone) {
  const auto [fall, cosine] = fall_at_30_deg(", vignetting: off");
  EXPECT_NEAR(fall, std::pow(cosine, 3), 0.004);
}

// A point loses the pupil's foreshortening alone: cos 30 deg, for a star and for an object.
TEST(LightOfARun, APointFallsOffByTheCosine) {
  const auto scene = [](const std::string& camera, const std::string& object) {
    return test::scenario("2018-03-06T03:00:00Z", 20, "site: atlanta", camera,
                          "{ra_deg: 120, dec_deg: 33}", 1, 5,
                          ", effects: {" + test::noiseless +
                              ", extinction: off, refraction: off, aberration: off, light_time: "
                              "off, shadow: off, earth_occultation: off}",
                          "", object + test::with_stars);
  };
  const std::string plain = test::camera(441, 21, 0.0035, "", ", aperture_m: 0.001");
  // 30 deg along the frame's rows, from 120 deg eastwards at declination 33 deg.
  const Vec<Gcrs> middle = from_spherical<Gcrs>(120 * deg, 33 * deg);
  const Vec<Gcrs> east{-std::sin(120 * deg), std::cos(120 * deg), 0};
  const Vec<Gcrs> aside = middle * std::cos(30 * deg) + east * std::sin(30 * deg);
  const auto [ra, dec] = to_spherical(aside);
  char csv[160], far[200];
  std::snprintf(
      csv, sizeof csv,
      "ra_deg,dec_deg,mag_v,bv,parallax_mas,pm_ra_mas_per_yr,pm_dec_mas_per_yr\n%.9f,%.9f,"
      "2,0.65,0,0,0\n",
      ra / deg, dec / deg);
  std::snprintf(far, sizeof far,
                "objects:\n  - name: o\n    motion: {fixed: {gcrs_m: [%.1f, %.1f, %.1f]}}\n    "
                "radius_m: 100\n",
                aside.x * 4e10, aside.y * 4e10, aside.z * 4e10);
  const auto light = [&](const std::string& camera) {
    test::Stage stage(scene(camera, far), csv);
    const auto frame = stage.frame();
    EXPECT_EQ(frame.stars.size(), 1u);
    EXPECT_EQ(frame.truths.size(), 1u);
    return std::pair(frame.stars.at(0).signal_e, frame.truths.at(0).rendered_signal_e);
  };
  const auto [star, satellite] = light(foreshortened);
  const auto [whole_star, whole_satellite] = light(plain);
  EXPECT_NEAR(star / whole_star, std::cos(30 * deg), 0.002);
  EXPECT_NEAR(satellite / whole_satellite, std::cos(30 * deg), 0.002);
}

// A star's light does not depend on which others are in the field, nor on their order.
TEST(LightOfARun, EachStarIsDimmedByItsOwnColour) {
  const auto signals = [](const std::string& rows) {
    test::Stage stage(
        test::scenario("2018-03-06T03:00:00Z", 20, "site: atlanta",
                       "{optics: {columns: 200, rows: 200, pixel_pitch_m: 1.0e-5, focal_length_m: "
                       "0.05, aperture_m: 0.02}, detector: {full_well_e: 1.0e+9, gain_e_per_dn: "
                       "1}, band: {filter: bessell-B}}",
                       "{azimuth_deg: 180, elevation_deg: 12}", 1, 5,
                       ", effects: {" + test::noiseless + "}", "", test::with_stars),
        "ra_deg,dec_deg,mag_v,bv\n" + rows);
    std::map<std::uint32_t, double> by_mag;  // in thousandths
    for (const auto& s : stage.frame().stars)
      by_mag[std::uint32_t(std::lround(1e3 * s.v_mag))] = s.signal_e;
    return by_mag;
  };
  // Sidereal time is 124 deg; four far ones stand around.
  const std::string far = "10,-80,5,0.1\n20,-80,5,1.9\n30,80,5,0.1\n40,80,5,1.9\n";
  const std::string red = "124.1,-44.0,4,1.8\n", blue = "124.4,-44.1,4.5,-0.2\n";
  const auto both = signals(far + red + blue), one = signals(red), other = signals(blue);
  ASSERT_EQ(both.size(), 2u);
  EXPECT_NEAR(both.at(4000) / one.at(4000), 1.0, 1e-6);
  EXPECT_NEAR(both.at(4500) / other.at(4500), 1.0, 1e-6);
}

// Reference: Krisciunas & Schaefer 1991 with the Moon and the Sun of ERFA, by
// tests/reference/wiring.py: one day of full Moon near perigee, one near apogee.
TEST(LightOfARun, MoonlightIsThatOfTheMoonOfTheDay) {
  const std::pair<const char*, double> days[] = {{"2018-01-31T06:00:00Z", 18.4048},
                                                 {"2018-07-27T06:00:00Z", 17.9967}};
  std::string in_v = test::camera(8, 8, 0.5);
  in_v.replace(in_v.find("band: {"), std::string::npos, "band: {filter: bessell-V}}");
  for (const auto& [start, v_mag] : days) {
    test::Stage stage(test::scenario(start, 20, mountain, in_v, "zenith", 1, 5,
                                     ", sky: dark, atmosphere: {extinction: 0.17}"));
    const auto& sensor = stage.scenario.sensors[0];
    const View view(sensor, frame_times(sensor, 1), stage.states);
    const double s10 = sky_over(view, {9.0}).part_s10(SkyPart::scattered_moonlight, {0, 0, 1});
    EXPECT_NEAR(mag_per_arcsec2_of_s10(s10), v_mag, 0.02) << start;
  }
}

// The light of a uniform sky at the aperture is the same everywhere, whatever the lens makes of it.
TEST(LightOfARun, TheRadianceOfAUniformSkyIsFlat) {
  test::Stage stage(uniform_sky(test::camera(
      441, 21, 0.0035, "", ", aperture_m: 0.001, vignetting: {natural: true, corner: 0.6}")));
  stage.scenario.output.radiance_exr = true;
  const auto& sensor = stage.scenario.sensors[0];
  FramePipeline pipeline({.sensor = sensor,
                          .clock = make_clock(stage.scenario),
                          .digest = "test",
                          .output = stage.scenario.output},
                         nullptr, stage.threads);
  const auto frame = pipeline.run(frame_times(sensor, 1), stage.states);
  const auto& map = frame.planes.radiance;
  const double centre = map.at(220, 10);
  ASSERT_GT(centre, 0.0);
  for (const int x : {0, 60, 130, 290, 380, 440})
    for (const int y : {0, 20}) EXPECT_NEAR(map.at(x, y) / centre, 1.0, 0.006) << x << " " << y;
}

// Inverse squares: the Moon at 356,500 km against 406,700 km, the least and greatest distances
// (Meeus, Astronomical Algorithms, chapter 50): 1.30.
TEST(LightOfARun, MoonlightAtPerigeeIsThirtyPerCentStronger) {
  const auto s10 = [](double distance_m) {
    SkyParts parts;
    parts.scattered_moonlight = ScatteredMoonlight{};
    const SkyScene scene{.sun = from_horizontal({3.0, -50 * deg}),
                         .moon = from_horizontal({0.0, 50 * deg}),
                         .moon_phase_rad = 0.3,
                         .moon_distance_m = distance_m,
                         .in_air = true};
    const SkyModel sky(parts, scene, johnson_v(), extinction_scaled_to(0.17));
    return sky.part_s10(SkyPart::scattered_moonlight, from_horizontal({1.5, 60 * deg}));
  };
  EXPECT_NEAR(s10(356.5e6) / s10(406.7e6), 1.3015, 0.002);
}

/// What the air takes from light from all around at an altitude of 20 deg, of 1 mag/airmass: two
/// thirds Rayleigh's, a third aerosols'. `f`: shares of both. Noll et al. 2012, A&A 543, A92.
double noll_mag(double f_rayleigh, double f_mie, double zenith_rad) {
  const double airmass =  // equation 2
      1 / (std::cos(zenith_rad) + 0.025 * std::exp(-11 * std::cos(zenith_rad)));
  return (2.0 / 3 * f_rayleigh + 1.0 / 3 * f_mie) * airmass;
}

// Reference: Noll et al. 2012, equations 18 and 19, for 160 S10 (2e-6 W/m2/um/sr).
TEST(LightOfARun, ZodiacalLightLosesWhatNollFindsAtTwentyDegrees) {
  SkyParts parts;
  parts.zodiacal_light = ZodiacalLight{};
  SkyScene scene{.sun = from_horizontal({0.0, -50 * deg})};
  const double k = 0.17;
  const SkyModel air(parts, scene, johnson_v(), extinction_scaled_to(k));
  scene.in_air = false;
  const SkyModel space(parts, scene, johnson_v(), {});
  Vec<Enu> at{};  // where it has 160 S10
  for (double azimuth_deg = 0; azimuth_deg < 360; azimuth_deg += 0.5) {
    const Vec<Enu> here = from_horizontal({azimuth_deg * deg, 20 * deg});
    const auto off = [&](const Vec<Enu>& v) {
      return std::abs(space.part_s10(SkyPart::zodiacal_light, v) - 160);
    };
    if (azimuth_deg == 0 || off(here) < off(at)) at = here;
  }
  const double s10 = space.part_s10(SkyPart::zodiacal_light, at);
  ASSERT_NEAR(s10, 160, 30);
  const double log_i = std::log10(1.28 * s10);  // 1e-8 W/m2/um/sr
  const double loss = magnitude_of_light(air.part_s10(SkyPart::zodiacal_light, at) / s10);
  EXPECT_NEAR(loss / k / noll_mag(0.527 * log_i - 0.715, 0.468 * log_i - 0.702, 70 * deg), 1.0,
              0.1);
}

// Reference: Noll et al. 2012, equations 23 to 25, against the zenith.
TEST(LightOfARun, AirglowLosesWhatNollFindsAtTwentyDegrees) {
  SkyParts parts;
  parts.airglow = Airglow{};
  const double k = 0.17;
  const SkyModel sky(parts, {}, johnson_v(), extinction_scaled_to(k));
  const auto noll = [&](double zenith_rad) {
    const double path = 1 / std::sqrt(1 - 0.972 * std::pow(std::sin(zenith_rad), 2));
    const double x = std::log10(path);
    return path *
           light_of_magnitude(k * noll_mag(1.669 * x - 0.146, 1.732 * x - 0.318, zenith_rad));
  };
  const auto ours = [&](double zenith_rad) {
    return sky.part_s10(SkyPart::airglow, from_horizontal({0.0, pi / 2 - zenith_rad}));
  };
  EXPECT_NEAR(ours(70 * deg) / ours(0) / (noll(70 * deg) / noll(0)), 1.0, 0.05);
  EXPECT_NEAR(ours(45 * deg) / ours(0) / (noll(45 * deg) / noll(0)), 1.0, 0.05);
}

}  // namespace
}  // namespace dmise
