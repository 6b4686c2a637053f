#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/optics/projection.h"
#include "core/photometry/magnitude.h"
#include "core/sky/bodies/limb_airglow.h"
#include "core/sky/bodies/limb_extinction.h"
#include "core/sky/limb_air.h"
#include "sensors/scene/throughput.h"
#include "tests/pipeline/body_scenes.h"

// Air and airglow over the Earth's limb in frames of a camera in space.
namespace dmise::test {
namespace {

Vec<Gcrs> to_sun() { return unit(bodies().sun_m); }
Vec<Gcrs> aside() { return unit(cross(to_sun(), Vec<Gcrs>{0, 0, 1})); }
constexpr double low_orbit_m = 6778e3;

/// Where a line from a place at an equator's height passes, towards `side` (unit, square to it).
Vec<Gcrs> over_limb(const Vec<Gcrs>& from_m, const Vec<Gcrs>& side, double height_m) {
  const double sine = std::min(1.0, (6378137.0 + height_m) / norm(from_m));
  return unit(from_m) * -std::sqrt(1 - sine * sine) + side * sine;
}

View view_of(const Stage& stage) {
  const auto& sensor = stage.scenario.sensors[0];
  return View(sensor, frame_times(sensor, 1), stage.states);
}

struct Seen {
  LimbLine line;
  Vec<Gcrs> direction;
};
Seen seen_at(const View& view, double x_px, double y_px) {
  const SimTime t = view.times().middle;
  const auto at = unproject(view.sensor().camera.optics, {x_px, y_px});
  const Vec<Gcrs> direction = view.camera_from_gcrs(t).inverse() * *at;
  return {LimbSight(view.observer(t).position_m, view.surface()).line(direction), direction};
}

/// Compares pixels with the model in their centres, where it is even over pixels.
template <class Light>
void expect_light(const Stage& stage, const ExpectedElectronImage& image, const Light& light,
                  double tolerance) {
  const View view = view_of(stage);
  const Optics& optics = view.sensor().camera.optics;
  double most = 0.0;
  for (const float e : image.pixels) most = std::max(most, double(e));
  ASSERT_GT(most, 0.0);
  for (int y = 3; y < image.rows - 3; y += 5)
    for (int x = 3; x < image.columns - 3; x += 7) {
      const Seen seen = seen_at(view, x, y);
      if (std::abs(seen.line.tangent_height_m()) < 5e3) continue;
      const double expected =
          light(seen) * area_m2(stage) * pixel_solid_angle_sr(optics, {double(x), double(y)});
      ASSERT_NEAR(image.at(x, y), expected, tolerance * expected + 1e-3 * most)
          << x << " " << y << " " << seen.line.tangent_height_m();
    }
}

const std::string alone = ", earth_disc: off, sun_disc: off, moon_disc: off";
const std::string sharp = ", psf_fwhm_px: 0.3";

std::string night(const std::string& effects, const std::string& detector = "",
                  const std::string& more_of_camera = sharp, int size_px = 600) {
  const Vec<Gcrs> from_m = to_sun() * -low_orbit_m;
  return in_space(from_m, towards(over_limb(from_m, aside(), 40e3)),
                  camera(size_px, size_px, 0.05, detector, more_of_camera), alone + effects);
}

// A bright line over a black Earth: OH and oxygen at 87 and 95 km, seen side on.
TEST(LimbInField, TheNightLimbHasItsLayer) {
  Stage stage(night(""));
  const auto image = light_of(stage);
  expect_finite(image);
  const AirglowShells shells(*stage.scenario.sensors[0].sky.parts.airglow,
                             stage.scenario.sensors[0].camera.band);
  const View view = view_of(stage);
  const LimbExtinction air(
      view.sensor().camera.band,
      LimbSight(view.observer(view.times().middle).position_m, view.surface()));
  expect_light(
      stage, image,
      [&](const Seen& s) { return shells.photons_per_s_m2_sr(s.line, air.of_surface(s.line)); },
      0.01);
  double most = 0.0, at_m = 0.0, on_ground = 0.0, between = 0.0;
  for (int y = 0; y < 600; y += 3)
    for (int x = 0; x < 600; x += 3) {
      const double height_m = seen_at(view, x, y).line.tangent_height_m(), e = image.at(x, y);
      if (e > most) most = e, at_m = height_m;
      if (height_m < -20e3) on_ground = std::max(on_ground, e);
      if (height_m > 3e3 && height_m < 6e3) between = std::max(between, e);
      EXPECT_TRUE(e == 0.0 || height_m <= 106e3) << height_m;
    }
  EXPECT_NEAR(at_m, 92e3, 2e3);
  EXPECT_LT(on_ground, 0.12 * most);  // the layer before the ground, seen slantwise
  EXPECT_LT(between, 0.15 * most);    // its far side is behind thick air
}

TEST(LimbInField, TheDawnLimbIsABlueArc) {
  // The Sun 4 deg below the limb.
  const double limb_rad = std::asin(6378137.0 / low_orbit_m), below_rad = 4 * deg;
  const double from_nadir = limb_rad - below_rad;
  const Vec<Gcrs> from_m =
      (to_sun() * -std::cos(from_nadir) - aside() * std::sin(from_nadir)) * low_orbit_m;
  const Vec<Gcrs> side = unit(to_sun() - unit(from_m) * dot(unit(from_m), to_sun()));
  double lights[2][3];
  int k = 0;
  for (const double um : {0.45, 0.85}) {
    Stage stage(in_space(from_m, towards(over_limb(from_m, side, 40e3)),
                         camera(600, 600, 0.05, "", sharp, um), alone + ", limb_airglow: off"));
    const auto image = light_of(stage);
    expect_finite(image);
    const View view = view_of(stage);
    const Band& band = view.sensor().camera.band;
    const LimbAirRadiance air(band, view.environment().sun_m, view.surface());
    expect_light(
        stage, image, [&](const Seen& s) { return air.photons_per_s_m2_sr(s.line, s.direction); },
        0.02);
    std::fill(lights[k], lights[k] + 3, 0.0);
    for (int y = 0; y < 600; y += 2)
      for (int x = 0; x < 600; x += 2) {
        const double height_m = seen_at(view, x, y).line.tangent_height_m();
        const double light = image.at(x, y) / sunlight_photons_per_s_m2(sun_v_mag, band);
        EXPECT_TRUE(light == 0.0 || height_m >= -2e3);
        double& of = lights[k][height_m < 8e3 ? 0 : height_m < 35e3 ? 1 : 2];
        if (height_m > 1e3 && height_m < 60e3) of = std::max(of, light);
      }
    ++k;
  }
  EXPECT_LT(lights[0][0], lights[1][0]);        // red on the ground,
  EXPECT_GT(lights[0][2], 5.0 * lights[1][2]);  // blue above
}

/// Integral of a radiance of the limb over all directions from a place.
template <class Light>
double whole_light(const View& view, double low_m, double high_m, const Light& light) {
  const SimTime t = view.times().middle;
  const Vec<Gcrs> from_m = view.observer(t).position_m, down = -unit(from_m);
  const LimbSight sight(from_m, view.surface());
  const Vec<Gcrs> u = unit(cross(down, Vec<Gcrs>{0.1, 0.2, 0.9})), v = cross(down, u);
  const double r = norm(from_m);
  constexpr int sectors = 180;
  double sum = 0.0;
  for (double low = std::asin((6378137.0 + low_m) / r), high = std::asin((6378137.0 + high_m) / r),
              step = (high - low) / 4000, rad = low + 0.5 * step;
       rad < high; rad += step)
    for (int k = 0; k < sectors; ++k) {
      const double at = 2 * pi * (k + 0.5) / sectors;
      const Vec<Gcrs> line =
          down * std::cos(rad) + (u * std::cos(at) + v * std::sin(at)) * std::sin(rad);
      sum += light(Seen{sight.line(line), line}) * std::sin(rad) * step * 2 * pi / sectors;
    }
  return sum;
}

// From a geostationary orbit pixels are 18 km wide and the air a line.
TEST(LimbInField, FromAGeostationaryOrbitPixelsHaveTheLightOfAll) {
  const Vec<Gcrs> from_m = unit(to_sun() + aside()) * 42164e3;
  const auto light_with = [&](const std::string& effects) {
    Stage stage(
        in_space(from_m, towards(-from_m), camera(801, 801, 0.02, "", sharp), alone + effects));
    const auto image = light_of(stage);
    expect_finite(image);
    return sum_of(image) / area_m2(stage);
  };
  Stage stage(in_space(from_m, towards(-from_m), camera(801, 801, 0.02), alone));
  const View view = view_of(stage);
  const Band& band = view.sensor().camera.band;
  const LimbAirRadiance air(band, view.environment().sun_m, view.surface());
  const double air_light = whole_light(view, -30e3, 110e3, [&](const Seen& s) {
    return air.photons_per_s_m2_sr(s.line, s.direction);
  });
  EXPECT_NEAR(light_with(", limb_airglow: off") / air_light, 1.0, 0.02);
  const AirglowShells shells(*view.sensor().sky.parts.airglow, band);
  const double glow =
      whole_light(view, -6378137.0, 0.0,
                  [&](const Seen& s) { return shells.photons_per_s_m2_sr(s.line); }) +
      whole_light(view, 0.0, 110e3,
                  [&](const Seen& s) { return shells.photons_per_s_m2_sr(s.line); });
  EXPECT_NEAR(light_with(", limb_air: off, limb_extinction: off") / glow, 1.0, 0.02);
}

// A camera whose upper edge looks at 100 km: the layer is in the margin of the frame and its blur
// comes in; a little further down it is in the frame.
TEST(LimbInField, AtTheEdgeOfTheFrame) {
  const Vec<Gcrs> from_m = to_sun() * -low_orbit_m;
  const auto sum = [&](double height_m) {
    Stage stage(in_space(from_m, towards(over_limb(from_m, aside(), height_m)),
                         camera(64, 64, 0.05, "", ", psf_fwhm_px: 6"), alone));
    const auto image = light_of(stage);
    expect_finite(image);
    return sum_of(image);
  };
  // 64 px are 30 km there.
  EXPECT_GT(sum(100e3), 0.0);
  EXPECT_GT(sum(100e3), sum(117e3));
  EXPECT_GT(sum(117e3), 0.0);
  EXPECT_EQ(sum(200e3), 0.0);
}

TEST(LimbInField, ActsWhereItIsSeenAlone) {
  Stage on(night("", "", sharp, 64));
  const auto plan = on.frame().report.plan;
  for (const char* effect : {"limb_airglow", "limb_air", "limb_extinction"})
    EXPECT_NE(plan.find(effect), std::string::npos) << effect;
  Stage off(night(", limb_airglow: off, limb_air: off, limb_extinction: off", "", sharp, 64));
  EXPECT_EQ(sum_of(light_of(off)), 0.0);
  EXPECT_EQ(off.frame().report.plan.find("limb_"), std::string::npos);
  const Vec<Gcrs> from_m = to_sun() * -low_orbit_m;
  Stage away(in_space(from_m, towards(from_m), camera(64, 64, 0.05), alone));
  EXPECT_EQ(away.frame().report.plan.find("limb_"), std::string::npos);
  Stage ground(scenario("2018-01-21T06:00:00Z", 5,
                        "site: {latitude_deg: 34.73, longitude_deg: -86.58, height_m: 190}",
                        camera(64, 64, 0.05), "{azimuth_deg: 0, elevation_deg: 1}", 0.01, 5,
                        more()));
  EXPECT_EQ(ground.frame().report.plan.find("limb_"), std::string::npos);
}

TEST(LimbInField, ThreadsAndRowsOfAStillCameraDoNotMatter) {
  Stage stage(night("", "", sharp, 200));
  const auto image = light_of(stage);
  Threads three(3);
  EXPECT_EQ(image.pixels, light_of(stage, three).pixels);
  Stage rolling(night("", "full_well_e: 1.0e+9, gain_e_per_dn: 1, row_time_us: 20", sharp, 200));
  const auto rolled = light_of(rolling);
  for (std::size_t i = 0; i < image.pixels.size(); ++i)
    ASSERT_NEAR(rolled.pixels[i], image.pixels[i], 1e-3 * image.pixels[i] + 1e-9);
}

// From within the layers, from below them and from a camera that sees all around.
TEST(LimbInField, IsFiniteFromWithinTheLayers) {
  for (const double height_m : {40e3, 90e3, 99e3, 150e3})
    for (const char* pointing : {"in", "level", "up"}) {
      const Vec<Gcrs> from_m = aside() * (6378137.0 + height_m);
      const Vec<Gcrs> line = pointing[0] == 'i'   ? -aside()
                             : pointing[0] == 'u' ? aside()
                                                  : to_sun();
      Stage stage(in_space(from_m, towards(line), camera(48, 48, 0.001, "", ", aperture_m: 0.0005"),
                           alone));
      expect_finite(light_of(stage));
    }
}

// A thermal camera sees neither.
TEST(LimbInField, AThermalCameraSeesNoAirglow) {
  const Vec<Gcrs> from_m = to_sun() * -low_orbit_m;
  Stage stage(in_space(from_m, towards(over_limb(from_m, aside(), 40e3)),
                       camera(64, 64, 0.01, "", "", 10.0), alone));
  const auto image = light_of(stage);
  expect_finite(image);
  EXPECT_EQ(sum_of(image), 0.0);
}

TEST(LimbInField, StarsBehindTheAirAreDimmedAndThingsBeforeItAreNot) {
  Stage stage(night("", "", sharp, 64));
  const View view = view_of(stage);
  const Throughput throughput(view);
  const Vec<Gcrs> from_m = to_sun() * -low_orbit_m;
  const LimbExtinction air(view.sensor().camera.band, LimbSight(from_m, view.surface()));
  for (const double height_m : {10e3, 20e3, 30e3, 50e3, 120e3}) {
    const Vec<Gcrs> line = over_limb(from_m, aside(), height_m);
    SightLine star{line, 0.65, SightLine::Source::star, 1};
    EXPECT_NEAR(throughput.of_air(star), air.of_point(line), 1e-6) << height_m;
    EXPECT_EQ(throughput.of_air(star) < 1.0, height_m < 100e3) << height_m;
    star.distance_m = 1000e3;
    EXPECT_EQ(throughput.of_air(star), 1.0);
  }
}

TEST(LimbInField, AStarInAFrameIsDimmedByTheAirBeforeIt) {
  const Vec<Gcrs> from_m = to_sun() * -low_orbit_m;
  const Vec<Gcrs> line = over_limb(from_m, aside(), 20e3);
  const auto [ra, dec] = to_spherical(line);
  char star[128];
  std::snprintf(star, sizeof star, "ra_deg,dec_deg,mag_v,bv\n%.8f,%.8f,4,0.65\n", ra / deg,
                dec / deg);
  const auto signal = [&](const std::string& effects) {
    Stage stage(in_space(from_m, towards(line), camera(64, 64, 0.05),
                         alone + ", annual_aberration: off, diurnal_aberration: off" + effects,
                         "stars: {catalogue: stars.csv, faintest_mag: 15}\n"),
                star);
    const auto frame = stage.frame();
    return frame.stars.empty() ? 0.0 : frame.stars.at(0).signal_e;
  };
  const double dimmed = signal(", limb_air: off, limb_airglow: off");
  const double whole = signal(", limb_air: off, limb_airglow: off, limb_extinction: off");
  Stage stage(night("", "", sharp, 64));
  const LimbExtinction air(stage.scenario.sensors[0].camera.band,
                           LimbSight(from_m, view_of(stage).surface()));
  EXPECT_GT(whole, 0.0);
  EXPECT_NEAR(dimmed / whole / air.of_point(line), 1.0, 0.02);
}

}  // namespace
}  // namespace dmise::test
