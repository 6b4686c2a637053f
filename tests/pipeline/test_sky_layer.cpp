#include "sensors/light/sky_layer.h"

#include <array>
#include <cmath>
#include <cstdio>

#include "core/effects/frame_effects.h"
#include "core/optics/projection.h"
#include "core/photometry/magnitude.h"
#include "core/sky/air/airmass.h"
#include "sensors/planning/exposure_planner.h"
#include "sensors/scene/throughput.h"
#include "tests/pipeline/harness.h"
#include "tests/support/data.h"
#include "tests/support/projections.h"

namespace dmise {
namespace {

constexpr double drawn_to_v_mag = 9.0;

/// A fisheye that sees the horizon all around, and a narrow camera.
const std::string fisheye =
    "{optics: {projection: equidistant, columns: 97, rows: 83, pixel_pitch_m: 10e-6,"
    " field_of_view_deg: 200, aperture_m: 0.001, equivalent_aperture: true},"
    " detector: {full_well_e: 1e9, gain_e_per_dn: 1}, band: {filter: bessell-V}}";
const std::string narrow =
    "{optics: {columns: 65, rows: 49, pixel_pitch_m: 100e-6, field_of_view_deg: 5, aperture_m: "
    "0.05},"
    " detector: {full_well_e: 1e9, gain_e_per_dn: 1}, band: {filter: bessell-V}}";

std::string scenario(const std::string& start, int minutes, const std::string& camera,
                     const std::string& pointing, const std::string& more) {
  return "simulation: {start: " + start + ", duration_s: " + std::to_string(60 * minutes) +
         ", tick_s: 30}\nstars: {catalogue: stars.csv, faintest_mag: 15}\n"
         "sensors: [{name: a, site: atlanta, camera: " +
         camera + ", pointing: " + pointing + ", exposure_s: 1, cadence_s: 60" + more + "}]\n";
}

ExpectedElectronImage sky_of(test::Stage& stage, std::uint32_t frame, std::size_t sensor = 0) {
  const auto& config = stage.scenario.sensors.at(sensor);
  const View view(config, frame_times(config, frame), stage.states);
  ExpectedElectronImage image(config.camera.optics.columns, config.camera.optics.rows);
  fill_sky(view, {drawn_to_v_mag}, image, stage.threads);
  return image;
}

double sum_of(const ExpectedElectronImage& image) {
  double sum = 0;
  for (const float e : image.pixels) sum += e;
  return sum;
}

/// Largest change of any pixel's logarithm from one frame to the next, and largest change of that
/// change: a step would show as large in the second as in the first.
struct Steps {
  double first = 0.0, second = 0.0, growth = 0.0;
};
Steps steps_over(test::Stage& stage, std::uint32_t frames) {
  Steps steps;
  std::vector<ExpectedElectronImage> last;
  for (std::uint32_t frame = 1; frame <= frames; ++frame) {
    ExpectedElectronImage image = sky_of(stage, frame);
    if (frame == 1) steps.growth = -sum_of(image);
    for (std::size_t i = 0; i < image.pixels.size(); ++i) {
      const float here = image.pixels[i];
      EXPECT_TRUE(std::isfinite(here) && here >= 0) << frame << " " << i;
      if (last.size() < 2 || here == 0 || last[0].pixels[i] == 0) continue;
      const double now = std::log(here / last[1].pixels[i]);
      const double before = std::log(last[1].pixels[i] / last[0].pixels[i]);
      steps.first = std::max(steps.first, std::abs(now));
      steps.second = std::max(steps.second, std::abs(now - before));
    }
    last.push_back(std::move(image));
    if (last.size() > 2) last.erase(last.begin());
  }
  steps.growth = sum_of(last.back()) / -steps.growth;
  return steps;
}

// The Moon, 95 % lit, comes over the horizon between 01:10 and 01:20 UTC. It rises by 0.2 deg a
// minute; within 10 deg of it the scattering function itself changes by a few percent in that.
TEST(SkyOverTime, TheMoonRisesWithoutAStep) {
  test::Stage stage(scenario("2018-02-03T00:45:00Z", 60, fisheye, "zenith", ", sky: dark"),
                    "ra_deg,dec_deg,mag_v\n0,90,6\n");
  const Steps steps = steps_over(stage, 60);
  RecordProperty("first", std::to_string(steps.first));
  RecordProperty("second", std::to_string(steps.second));
  EXPECT_GT(steps.growth, 1.5);
  EXPECT_LT(steps.first, 0.6);
  EXPECT_LT(steps.second, 0.05);
}

// From night, the Sun 19 deg down, to its rising. In the pixel at the horizon where the aureole
// rises, frames 87 to 91, the sky brightens by 2.3 mag for each degree.
TEST(SkyOverTime, DawnIsContinuous) {
  test::Stage stage(scenario("2018-02-18T10:50:00Z", 95, fisheye, "zenith", ", sky: dark"),
                    "ra_deg,dec_deg,mag_v\n0,90,6\n");
  EXPECT_LT(steps_over(stage, 86).first, 0.38);
  const Steps steps = steps_over(stage, 95);
  RecordProperty("first", std::to_string(steps.first));
  RecordProperty("second", std::to_string(steps.second));
  EXPECT_GT(steps.growth, 1e4);
  EXPECT_LT(steps.first, 0.45);
  EXPECT_LT(steps.second, 0.1);
}

// A camera that follows a star through the zenith: the sky over it hardly changes, and the star
// stays on its pixel but for refraction, which has no direction there.
TEST(SkyOverTime, ATransitOfTheZenithByTheCamerasAxis) {
  // Local sidereal time at Atlanta, 2018-01-21T04:00 UTC: 96.4 deg.
  test::Stage stage(scenario("2018-01-21T03:50:00Z", 20, narrow, "{ra_deg: 96.4, dec_deg: 33.777}",
                             ", sky: dark, effects: {scintillation: off}"),
                    "ra_deg,dec_deg,mag_v\n96.4,33.777,6\n");
  const Steps steps = steps_over(stage, 20);
  EXPECT_LT(steps.first, 0.01);
  EXPECT_LT(steps.second, 0.01);
  PixelPosition first{};
  double min_zenith_deg = 90;
  for (std::uint32_t frame = 1; frame <= 20; ++frame) {
    const auto made = stage.frame(frame);
    ASSERT_EQ(made.stars.size(), 1u);
    const PixelPosition at{made.stars[0].x_px, made.stars[0].y_px};
    if (frame == 1) first = at;
    EXPECT_NEAR(at.x_px, first.x_px, 0.02) << frame;
    EXPECT_NEAR(at.y_px, first.y_px, 0.02) << frame;
    const auto& config = stage.scenario.sensors[0];
    const View view(config, frame_times(config, frame), stage.states);
    const auto axis =
        view.camera_from_gcrs(view.times().middle).inverse() * Vec<CameraFrame>{0, 0, 1};
    min_zenith_deg = std::min(min_zenith_deg, angle_rad(axis, view.up(view.times().middle)) / deg);
  }
  EXPECT_LT(min_zenith_deg, 0.5);
}

TEST(SkyLayer, BelowTheHorizonIsDarkAndNothingIsNan) {
  test::Stage stage(scenario("2018-01-21T04:00:00Z", 2, fisheye, "zenith", ", sky: urban"),
                    "ra_deg,dec_deg,mag_v\n0,90,6\n");
  const auto& config = stage.scenario.sensors[0];
  const ExpectedElectronImage image = sky_of(stage, 1);
  int below = 0;
  for (int y = 0; y < image.rows; ++y)
    for (int x = 0; x < image.columns; ++x) {
      const auto direction = unproject(config.camera.optics, {double(x), double(y)});
      ASSERT_TRUE(std::isfinite(image.at(x, y)));
      if (!direction || direction->z < 0) {
        EXPECT_EQ(image.at(x, y), 0.0f) << x << " " << y;
        ++below;
      } else {
        EXPECT_GT(image.at(x, y), 0.0f) << x << " " << y;
      }
    }
  EXPECT_GT(below, 500);
}

// Every projection: the image is the model at each pixel, within the stated tolerance.
TEST(SkyLayer, IsWithinItsToleranceInEveryProjection) {
  for (const auto& projection : test::every_projection) {
    const std::string camera =
        "{optics: {projection: " + projection.yaml +
        ", columns: 333, rows: 251, pixel_pitch_m: 10e-6, field_of_view_deg: 120, aperture_m: "
        "0.001,"
        " equivalent_aperture: true},"
        " detector: {full_well_e: 1e9, gain_e_per_dn: 1}, band: {filter: sdss-g}}";
    test::Stage stage(
        scenario("2018-01-26T00:10:00Z", 2, camera, "{azimuth_deg: 200, elevation_deg: 45}",
                 ", sky: {preset: urban, cities: [{azimuth_deg: 230}]}"),
        "ra_deg,dec_deg,mag_v\n0,90,6\n");
    const auto& config = stage.scenario.sensors[0];
    const View view(config, frame_times(config, 1), stage.states);
    const SkyModel sky = sky_over(view, {drawn_to_v_mag});
    const ExpectedElectronImage image = sky_of(stage, 1);
    const SimTime t = view.times().middle;
    const auto enu_from_camera = view.enu_from_gcrs(t) * view.camera_from_gcrs(t).inverse();
    const double scale = Throughput(view).electrons_per_photon_m2() * view.times().seconds();
    double worst = 0;
    for (int y = 0; y < image.rows; y += 2)
      for (int x = 0; x < image.columns; x += 2) {
        const PixelPosition pixel{double(x), double(y)};
        const auto direction = enu_from_camera * *unproject(config.camera.optics, pixel);
        if (direction.z < 1e-6) continue;
        const double exact = sky.photons_per_s_m2_sr(direction) * scale *
                             pixel_solid_angle_sr(config.camera.optics, pixel);
        worst = std::max(worst, std::abs(image.at(x, y) / exact - 1));
      }
    EXPECT_LT(worst, SkyGrid::tolerance[std::size_t(SkyGrid::facts.unplanned())])
        << projection.name;
  }
}

/// Largest error of the sky's grid over the noise of a pixel, and its bound, by level.
struct GridErrors {
  std::array<double, SkyGrid::tolerance.size()> worst{}, bound{};
};

/// Errors in every pixel of a whole field that is not saturated.
GridErrors errors_of_grid(const std::string& start, const std::string& camera,
                          const std::string& exposure_s, const std::string& pointing = "zenith",
                          const std::string& sky = "dark") {
  const auto stage_at = [&](std::string_view level) {
    std::string text =
        scenario(start, 2, camera, pointing,
                 ", sky: " + sky + ", effects: {sky_grid: " + std::string(level) + "}");
    return text.replace(text.find("exposure_s: 1"), 13, "exposure_s: " + exposure_s);
  };
  const std::string stars = "ra_deg,dec_deg,mag_v\n0,90,6\n";
  test::Stage reference(stage_at("pixel"), stars);
  const ExpectedElectronImage exact = sky_of(reference, 1);
  const SensorConfig& config = reference.scenario.sensors[0];
  const View view(config, frame_times(config, 1), reference.states);
  const PlanFacts facts =
      ExposurePlanner(config, reference.stars.get(), drawn_to_v_mag, nullptr).facts(view, {});
  GridErrors errors;
  for (int level = 0; level < SkyGrid::facts.reference(); ++level) {
    test::Stage stage(stage_at(SkyGrid::levels[std::size_t(level)]), stars);
    const ExpectedElectronImage grid = sky_of(stage, 1);
    double& worst = errors.worst[std::size_t(level)];
    for (std::size_t i = 0; i < exact.pixels.size(); ++i) {
      const double light_e = exact.pixels[i];
      if (light_e >= facts.saturated_e) continue;
      const double noise_e =
          std::sqrt(light_e + facts.dark_e + facts.read_noise_e * facts.read_noise_e);
      worst = std::max(worst, std::abs(grid.pixels[i] - light_e) / noise_e);
    }
    errors.bound[std::size_t(level)] = SkyGrid::error(level, facts).background_sigma;
  }
  return errors;
}

// A whole frame of an all-sky sensor, which sees many nodes of the zodiacal table.
TEST(SkyLayer, EachLevelOfTheGridKeepsItsBoundOverTheWholeSky) {
  const GridErrors errors = errors_of_grid("2018-01-21T00:15:00Z", "omnissa", "20");
  for (std::size_t level = 0; level + 1 < SkyGrid::levels.size(); ++level) {
    EXPECT_LE(errors.worst[level], errors.bound[level]) << SkyGrid::levels[level];
    EXPECT_GT(errors.worst[level], 0.1 * errors.bound[level]) << SkyGrid::levels[level];
  }
}

// Patches of 2.7 deg where the sky is steep: at the horizon, towards the Sun 15 to 5 deg down and
// over a city; and pixels of 10 arcmin in a lens that is finer at its edges.
TEST(SkyLayer, EachLevelOfTheGridKeepsItsBoundInAFisheyeAtTwilight) {
  struct Case {
    const char *start, *camera, *exposure_s, *pointing, *sky;
  };
  for (const Case& c : {Case{"2018-02-18T11:10:00Z", "all-sky-scmos", "10", "zenith", "dark"},
                        Case{"2018-02-18T11:25:00Z", "all-sky-scmos", "10", "zenith", "dark"},
                        Case{"2018-02-18T11:40:00Z", "all-sky-scmos", "1", "zenith", "dark"},
                        Case{"2018-02-18T11:52:00Z", "all-sky-scmos", "0.1", "zenith", "dark"},
                        Case{"2018-02-16T05:00:00Z", "all-sky-scmos", "20", "zenith", "dark"},
                        Case{"2018-02-16T05:00:00Z", "all-sky-scmos", "20", "zenith",
                             "{preset: urban, cities: [{azimuth_deg: 230}]}"},
                        Case{"2018-02-18T11:25:00Z", "omnissa-swir", "1",
                             "{azimuth_deg: 100, elevation_deg: 30}", "dark"},
                        Case{"2018-02-18T11:25:00Z", "omnissa", "5",
                             "{azimuth_deg: 100, elevation_deg: 25}", "dark"}}) {
    const GridErrors errors = errors_of_grid(c.start, c.camera, c.exposure_s, c.pointing, c.sky);
    for (std::size_t level = 0; level + 1 < SkyGrid::levels.size(); ++level) {
      std::printf("%s %s %s: %s: %.3f sigma, stated %.3f\n", c.camera, c.start, c.sky,
                  std::string(SkyGrid::levels[level]).c_str(), errors.worst[level],
                  errors.bound[level]);
      EXPECT_LE(errors.worst[level], errors.bound[level])
          << c.camera << ' ' << c.start << ' ' << c.sky << ' ' << SkyGrid::levels[level];
    }
  }
}

TEST(SkyLayer, EachPartIsSwitchedByName) {
  const auto with = [](const std::string& effects) {
    test::Stage stage(scenario("2018-01-26T00:10:00Z", 2, fisheye, "zenith",
                               ", sky: urban, effects: {" + effects + "}"),
                      "ra_deg,dec_deg,mag_v\n0,90,6\n");
    return sum_of(sky_of(stage, 1));
  };
  const double whole = with("sky: on");
  double parts = 0;
  for (const std::string part : {"airglow", "zodiacal_light", "faint_starlight",
                                 "scattered_moonlight", "twilight", "light_pollution"}) {
    const double without = with(part + ": off");
    EXPECT_LT(without, whole) << part;
    parts += whole - without;
  }
  EXPECT_NEAR(parts / whole, 1.0, 0.01);
  EXPECT_EQ(with("sky: off"), 0.0);
}

// A veil of transmission 0.5 at the zenith takes as much from the star there as from the airglow
// behind it, and nothing from the lamps below.
TEST(Air, CloudsDimStarsAndSkyAlike) {
  const auto look = [](const std::string& sky, const std::string& clouds) {
    test::Stage stage(
        scenario(
            "2018-01-21T04:00:00Z", 2, narrow, "zenith",
            sky + clouds + ", effects: {scintillation: off, photon_noise: off, dark_current: off}"),
        "ra_deg,dec_deg,mag_v\n96.4,33.777,6\n");
    const auto frame = stage.frame();
    return std::pair(frame.stars.at(0).signal_e, sum_of(sky_of(stage, 1)));
  };
  const std::string glow = ", sky: {preset: dark, parts: {light_pollution: off}}";
  const auto [star, sky] = look(glow, "");
  const auto [dim_star, dim_sky] = look(glow, ", weather: {clouds: 0.5}");
  EXPECT_NEAR(dim_star / star, 0.5, 0.002);
  EXPECT_NEAR(dim_sky / sky, 0.5, 0.002);
}

// Young's formula for 0.05 m, 1 s, at the zenith and 300 m: sigma = sqrt(10e-6 x 0.05^(-4/3) x
// exp(-0.075)) = 2.244 %. 2,000 frames of one star: the deviation is known to 1.6 %.
TEST(Air, ScintillationHasYoungsDeviationAndMeanOne) {
  test::Stage stage(scenario("2018-01-21T04:00:00Z", 1, narrow, "zenith", ""),
                    "ra_deg,dec_deg,mag_v\n96.4,33.777,6\n");
  const auto& config = stage.scenario.sensors[0];
  double sum = 0, squares = 0;
  constexpr int frames = 2000;
  for (std::uint32_t frame = 1; frame <= frames; ++frame) {
    FrameTimes times = frame_times(config, 1);
    times.frame = frame;
    const View view(config, times, stage.states, 7);
    const SightLine star{view.up(times.middle), sun_bv, SightLine::Source::star, 42};
    const double f = Throughput(view).find<Scintillation>()->apply(star);
    sum += f, squares += f * f;
    EXPECT_EQ(f, Throughput(view).find<Scintillation>()->apply(star));
  }
  const double mean = sum / frames;
  EXPECT_NEAR(mean, 1.0, 3 * 0.0224 / std::sqrt(frames));
  EXPECT_NEAR(std::sqrt(squares / frames - mean * mean), 0.02244, 3 * 0.016 * 0.02244);
}

// Beer's law in the band, for a blue and a red star at 60 deg from the zenith: Kitt Peak's curve
// takes more from the blue one in a wide band.
TEST(Air, ExtinctionIsByBandColourAndAirmass) {
  test::Stage stage(scenario("2018-01-21T04:00:00Z", 1, narrow, "zenith",
                             ", atmosphere: {extinction: kitt_peak}"),
                    "ra_deg,dec_deg,mag_v\n0,90,6\n");
  const auto& config = stage.scenario.sensors[0];
  const View view(config, frame_times(config, 1), stage.states);
  const Throughput throughput(view);
  const auto of_air = [&](const Vec<Gcrs>& apparent, double bv) {
    return throughput.find<AirExtinction>()->apply({apparent, bv, SightLine::Source::star, 1});
  };
  const auto down = [&](double zenith_deg) {
    const Vec<Gcrs> up = view.up(view.times().middle);
    const Vec<Gcrs> side = unit(cross(up, {0.1, 0.2, 0.9}));
    return up * std::cos(zenith_deg * deg) + side * std::sin(zenith_deg * deg);
  };
  const double k_zenith = magnitude_of_light(of_air(down(0), 0.65));
  EXPECT_NEAR(k_zenith, 0.153, 0.004);  // the curve has 0.150 at 550 nm, 0.161 at 525
  EXPECT_NEAR(magnitude_of_light(of_air(down(60), 0.65)) / k_zenith, airmass(30 * deg), 0.01);
  EXPECT_LT(of_air(down(60), -0.3), of_air(down(60), 1.8));
  for (const double zenith_deg : {89.0, 90.0, 91.0, 120.0, 180.0}) {
    const double t = of_air(down(zenith_deg), 0.65);
    EXPECT_TRUE(t > 0 && t < 0.1) << zenith_deg;
  }
}

// Stars are drawn one by one to a limit and smeared out beyond it: where the limit lies changes
// only the model's 30 % of structure along the Milky Way, by the share of the sky between both
// limits.
TEST(StarlightInAll, IsTheSameForAnyLimitOfTheStarsDrawn) {
  for (const char* pointing : {"{ra_deg: 90, dec_deg: 25}", "{ra_deg: 190, dec_deg: 30}"}) {
    const auto counted = [&](const std::string& stars) {
      const std::string camera =
          "{optics: {columns: 401, rows: 401, pixel_pitch_m: 10e-6, field_of_view_deg: 20,"
          " aperture_m: 0.01},"
          " detector: {full_well_e: 1e9, gain_e_per_dn: 1}, band: {filter: bessell-V}}";
      test::Stage stage("simulation: {start: 2018-01-16T05:00:00Z, duration_s: 30, tick_s: 30}\n" +
                        stars + "sensors: [{name: a, site: atlanta, camera: " + camera +
                        ", pointing: " + pointing +
                        ", exposure_s: 1, cadence_s: 30, sky: dark, effects: {scintillation: off,"
                        " photon_noise: off, read_noise: off}}]\n");
      double sum = 0;
      const auto frame = stage.frame();
      for (const auto count : frame.counts.pixels) sum += double(count) - frame.header.bias_dn;
      return sum;
    };
    const std::string kstars = test::catalogue_path("stars.dat.gz");
    const double to_9 = counted("stars: {catalogue: " + kstars + ", faintest_mag: 9}\n");
    const double to_6 = counted("stars: {catalogue: " + kstars + ", faintest_mag: 6}\n");
    EXPECT_NEAR(to_6 / to_9, 1.0, 0.02) << pointing;
    EXPECT_NEAR(counted("") / to_9, 1.0, 0.04) << pointing;  // but for stars brighter than V = 5
  }
}

}  // namespace
}  // namespace dmise
