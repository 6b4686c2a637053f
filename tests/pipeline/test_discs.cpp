#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/sky/bodies/earth_disc.h"
#include "core/sky/bodies/moon_disc.h"
#include "core/sky/bodies/sun_disc.h"
#include "sensors/scene/bodies_in_field.h"
#include "tests/pipeline/body_scenes.h"

// Discs of Sun, Moon and Earth in frames.
namespace dmise::test {
namespace {

const std::string huntsville = "site: {latitude_deg: 34.73, longitude_deg: -86.58, height_m: 190}";

// Reference: astropy 5.2, get_body("moon", ..., ephemeris="builtin") from the site, of which erfa
// has the positions; the radius is that of 1737.4 km.
struct MoonRow {
  const char* time;
  double ra_deg, dec_deg, radius_arcsec, phase_deg, distance_m;
};
const MoonRow full{"2018-01-02T06:00:00Z", 104.5490132, 19.7747247, 1022.382, 3.6660, 350520646};
const MoonRow half{"2018-01-09T12:00:00Z", 205.5075456, -5.8656249, 924.812, 96.6904, 387501007.5};
const MoonRow crescent{
    "2018-01-16T22:30:00Z", 295.6299818, -19.9625799, 885.067, 177.1438, 404902320.9};
const MoonRow waxing{
    "2018-01-20T23:00:00Z", 345.2056711, -9.5144274, 913.626, 137.6933, 392245274.5};

constexpr double arcsec_px = 1e-5 / 0.5 / pi * 180 * 3600;

std::string of_moon(const MoonRow& row, const std::string& effects = "", int size_px = 560) {
  return scenario(row.time, 5, huntsville, camera(size_px, size_px, 0.5),
                  radec(row.ra_deg, row.dec_deg), 0.01, 5,
                  more(", refraction: off, extinction: off, annual_aberration: off, "
                       "diurnal_aberration: off" +
                       effects));
}

TEST(MoonInField, StandsWhereAstropyHasIt) {
  for (const MoonRow& row : {full, half, crescent, waxing}) {
    Stage stage(scenario(row.time, 5, huntsville, camera(64, 64, 0.5),
                         radec(row.ra_deg, row.dec_deg), 0.01, 5, more()));
    const View view(stage.scenario.sensors[0], frame_times(stage.scenario.sensors[0], 1),
                    stage.states);
    const SeenBody moon = seen_moon(view, view.times().middle);
    const auto there = from_spherical<Gcrs>(row.ra_deg * deg, row.dec_deg * deg);
    EXPECT_LT(angle_rad(moon.above_air_m, there) / arcsec, 0.6) << row.time;
    EXPECT_NEAR(moon.radius_rad / arcsec, row.radius_arcsec, 0.1) << row.time;
    const MoonRadiance radiance(johnson_v(), moon.above_air_m,
                                seen_sun(view, view.times().middle).above_air_m);
    EXPECT_NEAR(radiance.phase_rad() / deg, row.phase_deg, 0.01) << row.time;
  }
}

// By the magnitude of Krisciunas & Schaefer 1991, written out here.
TEST(MoonInField, HasTheLightOfItsMagnitude) {
  for (const MoonRow& row : {full, half, waxing}) {
    Stage stage(of_moon(row));
    const auto image = light_of(stage);
    const double a = row.phase_deg, surge = std::max(0.0, 1 - a / 7) * 2.5 * std::log10(1.35);
    const double v_mag = -12.73 + 0.026 * a + 4e-9 * a * a * a * a - surge +
                         5 * std::log10(row.distance_m / 384.4e6);
    const Band& band = stage.scenario.sensors[0].camera.band;
    const double expected = moonlight_photons_per_s_m2(v_mag, band) * area_m2(stage);
    EXPECT_NEAR(sum_of(image) / expected, 1.0, 5e-3) << row.time;
  }
}

TEST(MoonInField, FullMoonHasItsRadius) {
  Stage stage(of_moon(full));
  const auto image = light_of(stage);
  const float half_bright = 0.5f * image.at(280, 280);
  const auto lit = std::count_if(image.pixels.begin(), image.pixels.end(),
                                 [&](float e) { return e > half_bright; });
  // Half a pixel; the dark rim of this phase takes 0.1 % of the radius.
  EXPECT_NEAR(std::sqrt(double(lit) / pi) * arcsec_px, full.radius_arcsec, 0.5 * arcsec_px);
}

// A crescent of 0.55 px: all its light is on the limb that faces the Sun.
TEST(MoonInField, ACrescentIsOnTheLimbThatFacesTheSun) {
  Stage stage(of_moon(crescent));
  const View view(stage.scenario.sensors[0], frame_times(stage.scenario.sensors[0], 1),
                  stage.states);
  const SimTime t = view.times().middle;
  const Vec<Gcrs> moon_m = seen_moon(view, t).above_air_m;
  const Vec<CameraFrame> sun =
      view.camera_from_gcrs(t) * unit(seen_sun(view, t).above_air_m - moon_m);
  const double toward = std::hypot(sun.x, sun.y);
  const auto image = light_of(stage);
  double light = 0, along = 0, inside = 0;
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.columns; ++x) {
      const double e = image.at(x, y), dx = x - 279.5, dy = y - 279.5;
      light += e;
      along += e * (dx * sun.x + dy * sun.y) / toward;
      if (std::hypot(dx, dy) < crescent.radius_arcsec / arcsec_px - 8.0) inside += e;
    }
  EXPECT_GT(light, 0.0);
  // Half a turn of a thin crescent has its mean at 2/pi to 3/4 of the radius.
  EXPECT_NEAR(along / light / (crescent.radius_arcsec / arcsec_px), 0.75, 0.1);
  EXPECT_LT(inside, 1e-3 * light);
  const Band& band = stage.scenario.sensors[0].camera.band;
  EXPECT_NEAR(light / (moonlight_photons_per_s_m2(moon_disc_v_mag(crescent.phase_deg * deg) +
                                                      5 * std::log10(crescent.distance_m / 384.4e6),
                                                  band) *
                       area_m2(stage)),
              1.0, 0.03);
}

// Reference: astropy 5.2, altitude and azimuth without refraction.
TEST(MoonInField, SetsBehindTheHorizonAndIsFlattenedThere) {
  const auto set = [](const char* time, double azimuth_deg, double elevation_deg) {
    char pointing[96];
    std::snprintf(pointing, sizeof pointing, "{azimuth_deg: %.4f, elevation_deg: %.4f}",
                  azimuth_deg, elevation_deg);
    return scenario(time, 5, huntsville, camera(600, 600, 0.5), pointing, 0.01, 5, more());
  };
  Stage partly(set("2018-01-02T13:12:05Z", 294.0355, 0.0));
  const auto image = light_of(partly);
  double above = 0, below = 0;
  for (int y = 0; y < 600; ++y)
    for (int x = 0; x < 600; ++x) (y < 310 ? above : below) += image.at(x, y);
  EXPECT_GT(above, 0.0);
  EXPECT_EQ(below, 0.0);
  // The flattening of the setting Sun is 1/6 (Meeus 1998, Astronomical Algorithms, chapter 16:
  // 34.5' on the horizon and 28.5' half a degree above).
  Stage whole(set("2018-01-02T13:10:20Z", 293.7991, 0.28));
  const auto disc = light_of(whole);
  const float brightest = *std::max_element(disc.pixels.begin(), disc.pixels.end());
  int left = 600, right = 0, top = 600, bottom = 0;
  for (int y = 0; y < 600; ++y)
    for (int x = 0; x < 600; ++x)
      if (disc.at(x, y) > 0.02f * brightest) {
        left = std::min(left, x);
        right = std::max(right, x);
        top = std::min(top, y);
        bottom = std::max(bottom, y);
      }
  EXPECT_NEAR(double(bottom - top + 1) / (right - left + 1), 0.84, 0.03);
}

// Lambert's sphere seen from far away; the ellipsoid is up to 0.3 % larger and smaller.
TEST(EarthInField, HasTheLightOfALambertSphere) {
  for (const Vec<Gcrs>& at : {Vec<Gcrs>{1, 0.2, 0.1}, Vec<Gcrs>{0, 1, 0}, Vec<Gcrs>{-1, 0.5, 0}}) {
    const Vec<Gcrs> from_m = unit(at) * 9e9;
    Stage stage(in_space(from_m, towards(-from_m), camera(320, 320, 2.0), no_air, "",
                         ", earth_albedo: 0.4"));
    const double a = angle_rad(bodies().sun_m, from_m), size = 6371e3 / 9e9;
    const double au = norm(bodies().sun_m) / 149597870700.0;
    const double expected =
        sunlight_photons_per_s_m2(-26.76, stage.scenario.sensors[0].camera.band) / (au * au) *
        (2.0 / 3) * 0.4 * size * size * (std::sin(a) + (pi - a) * std::cos(a)) / pi *
        area_m2(stage);
    EXPECT_NEAR(sum_of(light_of(stage)) / expected, 1.0, 0.015) << a / deg;
  }
}

TEST(EarthInField, FillsTheWholeFieldFromALowOrbit) {
  const Vec<Gcrs> day_m = unit(bodies().sun_m) * 6900e3;
  Stage day(in_space(day_m, towards(-day_m), camera(64, 64, 0.05)));
  const auto image = light_of(day);
  const auto [least, most] = std::minmax_element(image.pixels.begin(), image.pixels.end());
  EXPECT_GT(*least, 0.99f * *most);  // under the Sun
  // A surface of albedo 0.3 there: radiance x the pixel's solid angle.
  const double au = norm(bodies().sun_m) / 149597870700.0;
  const double expected = sunlight_photons_per_s_m2(-26.76, day.scenario.sensors[0].camera.band) /
                          (au * au) * 0.3 / pi * 4e-8 * area_m2(day);
  EXPECT_NEAR(image.at(32, 32) / expected, 1.0, 2e-3);
}

TEST(EarthInField, ItsNightSideIsDark) {
  const Vec<Gcrs> night_m = -unit(bodies().sun_m) * 6900e3;
  Stage night(in_space(night_m, towards(-night_m), camera(64, 64, 0.05), no_air));
  EXPECT_EQ(sum_of(light_of(night)), 0.0);
}

TEST(EarthInField, IsNotSeenFromTheGround) {
  Stage stage(scenario("2018-01-21T18:00:00Z", 5, huntsville, camera(64, 64, 0.05),
                       "{azimuth_deg: 0, elevation_deg: -60}", 0.01, 5, more()));
  EXPECT_EQ(sum_of(light_of(stage)), 0.0);
}

// The limb of the lit Earth from a geosynchronous orbit.
TEST(EarthInField, ItsLimbIsWhereTheEllipsoidIs) {
  const Vec<Gcrs> from_m = unit(Vec<Gcrs>{bodies().sun_m.x, bodies().sun_m.y, 0}) * 42164e3;
  Stage stage(
      in_space(from_m, towards(-from_m), camera(801, 801, 0.02, "", ", psf_fwhm_px: 0.3"), no_air));
  const auto image = light_of(stage);
  int lit = 0;  // along the equator
  for (int x = 0; x < 801; ++x) lit += image.at(x, 400) > 0.0f;
  const double radius_px = std::tan(std::asin(6378137.0 / 42164e3)) * 0.02 / 1e-5;
  EXPECT_NEAR(lit, 2 * radius_px, 3.0);
}

TEST(SunInField, HasItsLightAndSaturates) {
  const Vec<Gcrs> at_m{4.2e7, 1e6, 2e6};
  const std::string small = camera(300, 300, 0.2);
  Stage stage(in_space(at_m, towards(bodies().sun_m - at_m), small));
  const auto image = light_of(stage);
  const double au = norm(bodies().sun_m - at_m) / 149597870700.0;
  const double expected = sunlight_photons_per_s_m2(-26.76, stage.scenario.sensors[0].camera.band) /
                          (au * au) * area_m2(stage);
  EXPECT_NEAR(sum_of(image) / expected, 1.0, 3e-3);
  EXPECT_GT(image.at(150, 150), 1.5f * image.at(150 + 90, 150));  // it darkens
  const auto frame = stage.frame();
  EXPECT_EQ(frame.counts.at(150, 150), 65535);
  // Half of it: on the edge of a frame whose boresight is 150 px aside.
  const auto [ra, dec] = to_spherical(bodies().sun_m - at_m);
  Stage edge(in_space(at_m, radec(ra / deg, dec / deg + std::atan(150 * 1e-5 / 0.2) / deg), small));
  EXPECT_NEAR(sum_of(light_of(edge)) / expected, 0.5, 0.01);
}

TEST(SunInField, TheMoonEclipsesIt) {
  const Vec<Gcrs> line = unit(bodies().sun_m - bodies().moon_m);
  const Vec<Gcrs> at_m = bodies().moon_m - line * 3.5e8;
  Stage dark(
      in_space(at_m, towards(bodies().sun_m - at_m), camera(300, 300, 0.2), ", earth_disc: off"));
  Stage bright(in_space(at_m, towards(bodies().sun_m - at_m), camera(300, 300, 0.2),
                        ", earth_disc: off, sun_disc: off"));
  EXPECT_EQ(sum_of(light_of(dark)), sum_of(light_of(bright)));  // totality
}

// Blurs of every method keep the light, and threads do not matter.
TEST(DiscsInField, AreBlurredByEveryMethodAndKeepTheirLight) {
  const Vec<Gcrs> at_m{4.2e7, 1e6, 2e6};
  const std::string pointing = towards(bodies().moon_m - at_m);
  const auto sum = [&](const std::string& optics) {
    Stage stage(in_space(at_m, pointing, camera(240, 240, 0.2, "", optics)));
    const auto image = light_of(stage);
    Threads three(3);
    EXPECT_EQ(image.pixels, light_of(stage, three).pixels) << optics;
    expect_finite(image);
    return sum_of(image);
  };
  const double sharp = sum(", psf_fwhm_px: 0.3");
  EXPECT_GT(sharp, 0.0);
  EXPECT_NEAR(sum(", psf_fwhm_px: 4") / sharp, 1.0, 1e-4);
  EXPECT_NEAR(sum(", psf: diffraction, aperture_m: 0.01, method: transform") * 4 / sharp, 1.0,
              0.01);
}

TEST(DiscsInField, AreSmallInAFisheyeWithEverythingInIt) {
  const Vec<Gcrs> at_m = unit(bodies().sun_m + Vec<Gcrs>{0, 0, 6e10}) * 2e7;
  // Half way between the Sun and the Moon; the Earth reaches into the field.
  const Vec<Gcrs> middle = unit(unit(bodies().sun_m) + unit(bodies().moon_m));
  const auto fisheye = [](int size) {
    return camera(size, size, 1.0, "",
                  ", projection: equidistant, field_of_view_deg: 180, aperture_m: 0.0002");
  };
  const auto text = [&](const std::string& effects, int size) {
    std::string yaml = in_space(at_m, towards(middle), fisheye(size), effects);
    const std::string focal = ", focal_length_m: 1.000000";
    return yaml.erase(yaml.find(focal), focal.size());
  };
  double sums[4];
  int i = 0;
  for (const std::string effects :
       {"", ", sun_disc: off", ", moon_disc: off", ", earth_disc: off"}) {
    Stage stage(text(effects, 256));
    const auto image = light_of(stage);
    expect_finite(image);
    sums[i++] = sum_of(image);
  }
  Stage any(text("", 256));
  const double area = area_m2(any);
  const Band& band = any.scenario.sensors[0].camera.band;
  const double au = norm(bodies().sun_m - at_m) / 149597870700.0;
  EXPECT_NEAR((sums[0] - sums[1]) / (sunlight_photons_per_s_m2(-26.76, band) / au / au * area), 1.0,
              0.01);
  const Vec<Gcrs> moon_m = bodies().moon_m - at_m;
  EXPECT_NEAR((sums[0] - sums[2]) /
                  (MoonRadiance(band, moon_m, bodies().sun_m - at_m).photons_per_s_m2() * area),
              1.0, 0.05);
}

TEST(DiscsInField, CanBeSwitchedOffAndActWhereTheyAreSeenAlone) {
  Stage off(of_moon(half, ", moon_disc: off"));
  EXPECT_EQ(sum_of(light_of(off)), 0.0);
  Stage on(of_moon(half));
  EXPECT_NE(on.frame().report.plan.find("moon_disc"), std::string::npos);
  MoonRow beside = half;
  beside.ra_deg += 5;
  Stage elsewhere(of_moon(beside));
  EXPECT_EQ(elsewhere.frame().report.plan.find("_disc"), std::string::npos);
}

PixelPosition centre_of_light(const ExpectedElectronImage& image) {
  PixelPosition sum;
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.columns; ++x)
      sum = sum + PixelPosition{double(x), double(y)} * double(image.at(x, y));
  return sum * (1.0 / sum_of(image));
}

// The Sun is seen 20.5 arcsec and the Moon 0.7 from where it is when the light comes, by the
// Earth's and its own way.
TEST(DiscsInField, PlansDrawThemWhereTheirLightComesFrom) {
  const Vec<Gcrs> at_m{4.2e7, 1e6, 2e6};
  for (const auto& middle_m : {bodies().sun_m, bodies().moon_m})
    for (const char* accuracy : {"standard", "reference"}) {
      Stage stage(in_space(at_m, towards(middle_m - at_m), camera(300, 300, 0.2)) +
                  "\naccuracy: " + accuracy + "\n");
      const auto plan = stage.frame().report.plan;
      const bool sun = norm(middle_m) > 1e10;
      EXPECT_TRUE(!sun || plan.find("light_time") != std::string::npos) << plan;
      const auto image = light_of(stage);
      Stage whole(in_space(at_m, towards(middle_m - at_m), camera(300, 300, 0.2)));
      const PixelPosition off = centre_of_light(image) - centre_of_light(light_of(whole));
      EXPECT_LT(std::hypot(off.x_px, off.y_px), 0.05) << plan;
    }
}

TEST(DiscsInField, AnObjectWithAShapeHidesWhatIsBehind) {
  const Vec<Gcrs> at_m = unit(bodies().sun_m) * 4.2e7, line = -unit(at_m);
  const Vec<Gcrs> box_m = at_m + line * 2e4;
  char box[320];
  std::snprintf(box, sizeof box,
                "  - name: box\n    motion: {fixed: {gcrs_m: [%.3f, %.3f, %.3f]}}\n    attitude: "
                "{inertial: {gcrs_from_body: [1, 0, 0, 0]}}\n    geometry: {model: box, size_m: "
                "[20, 20, 20], material: dark, materials: %s}\n",
                box_m.x, box_m.y, box_m.z, DMISE_SOURCE_DIR "/tests/pipeline/plain.yaml");
  Stage stage(in_space(at_m, towards(line), camera(128, 128, 0.5), "", box));
  const auto& config = stage.scenario.sensors[0];
  OutputConfig output;
  output.background = output.sources = true;
  FramePipeline pipeline({.sensor = config,
                          .clock = make_clock(stage.scenario),
                          .digest = "test",
                          .output = output,
                          .shapes = std::make_shared<const ObjectShapes>(
                              stage.scenario.own_objects, config.camera.band, config.effects)},
                         nullptr, stage.threads);
  const auto planes = pipeline.run(frame_times(config, 1), stage.states).planes;
  const double earth = planes.background.at(64, 64);
  EXPECT_GT(earth, 0.0);
  EXPECT_NEAR(planes.sources.at(64, 64) / earth, -1.0, 1e-3);  // it is before it
  EXPECT_NEAR(planes.sources.at(4, 4) / earth, 0.0, 1e-3);
}

}  // namespace
}  // namespace dmise::test
