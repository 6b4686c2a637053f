#include <cmath>

#include "core/effects/frame_effects.h"
#include "core/image/fits_file.h"
#include "core/optics/point_spread.h"
#include "core/photometry/magnitude.h"
#include "tests/pipeline/harness.h"

namespace dmise {
namespace {

const std::string elements =
    "GOES 16\n"
    "1 41866U 16071A   18019.87773469 -.00000245  00000-0  00000-0 0  9992\n"
    "2 41866   0.0069 115.0916 0001074 269.6956 335.2025  1.00271237  4322\n";

std::string scenario(const std::string& effects) {
  return "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 30, tick_s: 5}\n"
         "objects: [{catalogue: objects.tle}]\nstars: {catalogue: stars.csv, faintest_mag: 15}\n"
         "effects: " +
         effects +
         "\nsensors:\n"
         "  - {name: watch, site: savannah, camera: geo-watch, pointing: {azimuth_deg: 168.7,"
         " elevation_deg: 52}, exposure_s: 5, cadence_s: 10}\n";
}

const std::string no_noise =
    "scintillation: off, photon_noise: off, dark_current: off, read_noise: off, full_well: off,"
    " quantisation: off";

TEST(FramePipeline, AStarsElectronsAreItsPhotonsTimesAreaAndEfficiency) {
  // A V = 6 star of the Sun's colour where the camera looks; the closed form is written out here.
  test::Stage stage(scenario("{sky: off, extinction: off, " + no_noise + "}"),
                    "ra_deg,dec_deg,mag_v,bv\n49.7,-5.4,6,0.65\n", elements);
  const auto frame = stage.frame();
  ASSERT_EQ(frame.stars.size(), 1u);
  const auto& camera = stage.scenario.sensors[0].camera;
  const double area_m2 = 3.14159265358979 / 4 * std::pow(camera.optics.aperture_m, 2);
  const double expected_e =
      StarLight(camera.band).photons_per_s_m2(6, 0.65) * area_m2 * 0.80 * 0.54 * 5;
  EXPECT_NEAR(frame.stars[0].signal_e / expected_e, 1.0, 1e-3);
  double sum = 0;
  for (const auto count : frame.counts.pixels) sum += count;
  EXPECT_NEAR(sum / expected_e, 1.0,
              2e-2);  // counts are rounded, wings are lost below half an electron
}

TEST(FramePipeline, ExtinctionDimsByTheAirmass) {
  const std::string star = "ra_deg,dec_deg,mag_v,bv\n49.7,-5.4,6,0.65\n";
  test::Stage clear(scenario("{sky: off, extinction: off, " + no_noise + "}"), star, elements);
  const double without = clear.frame().stars.at(0).signal_e;
  test::Stage air(scenario("{sky: off, " + no_noise + "}"), star, elements);
  const double with = air.frame().stars.at(0).signal_e;
  // 0.17 mag an airmass at about 52 deg elevation: X = 1.267.
  EXPECT_NEAR(magnitude_of_light(with / without), 0.17 * 1.267, 0.17 * 0.04);
}

TEST(FramePipeline, SwitchedEffectsLeaveTheFrame) {
  const std::string star = "ra_deg,dec_deg,mag_v\n49.7,-5.4,6\n";
  test::Stage none(scenario("{sky: off, stars: off, objects: off, " + no_noise + "}"), star,
                   elements);
  const auto frame = none.frame();
  for (const auto count : frame.counts.pixels) ASSERT_EQ(count, 0);
  EXPECT_EQ(frame.report.stars_rendered, 0u);
  EXPECT_EQ(frame.report.plan.find("stars"), std::string::npos);
  EXPECT_NE(frame.report.plan.find("refraction"), std::string::npos);
}

TEST(FramePipeline, WithoutDetectionTheFrameIsTheSameAndItsReportSaysWhatTheHeaderDoes) {
  const std::string star = "ra_deg,dec_deg,mag_v\n49.7,-5.4,6\n";
  test::Stage with(scenario("{}"), star, elements);
  const auto found = with.frame();
  test::Stage without("detection: off\n" + scenario("{}"), star, elements);
  const auto frame = without.frame();
  EXPECT_GT(found.detections.size() + found.report.star_like, 0u);
  EXPECT_TRUE(frame.counts.pixels == found.counts.pixels);
  EXPECT_TRUE(frame.detections.empty());
  EXPECT_TRUE(frame.report.detection_off);
  EXPECT_FALSE(found.report.detection_off);
  EXPECT_EQ(frame.report.limiting_magnitude, 0.0);
  EXPECT_EQ(frame.report.wcs, found.report.wcs);
  EXPECT_EQ(frame.report.middle, found.report.middle);
  EXPECT_EQ(frame.report.boresight_ra_rad, found.report.boresight_ra_rad);
  EXPECT_EQ(frame.report.objects_rendered, found.report.objects_rendered);
  EXPECT_NE(physics_json(with.scenario), physics_json(without.scenario));
}

TEST(FramePipeline, AFinderTakesThePlaceOfOurDetector) {
  test::Stage stage(scenario("{}"), "ra_deg,dec_deg,mag_v\n49.7,-5.4,6\n", elements);
  SensorConfig config = stage.scenario.sensors[0];
  config.detector = {.node = "finder", .where = "s.yaml:1:1: sensors[0].detection.node"};
  const auto made = [&](SourceFinder finder) {
    FramePipeline pipeline({.sensor = config,
                            .clock = make_clock(stage.scenario),
                            .digest = "test",
                            .finder = std::move(finder)},
                           stage.stars, stage.threads);
    return pipeline.run(frame_times(config, 2), stage.states);
  };
  std::string told;
  const FrameProducts frame = made([&](const CountImage& counts, const FrameHeader& header) {
    told = encode_frame(counts, header);
    return std::vector{
        MeasuredSource{.centroid = {{30, 40}, {0.1, 0, 0.1}}, .light_e = 1e4, .snr = 9}};
  });
  EXPECT_TRUE(told == encode_frame(frame.counts, frame.header)) << "it is told what the file has";
  ASSERT_EQ(frame.detections.size(), 1u);
  EXPECT_EQ(frame.detections[0].id, "watch/2/0");
  EXPECT_EQ(frame.report.detections, 1u);
  EXPECT_FALSE(frame.stopped || frame.report.detection_off);
  EXPECT_TRUE(made([](const auto&, const auto&) { return std::nullopt; }).stopped);
  EXPECT_THROW(made({}), ConfigError) << "commands that start no programs";
}

TEST(FramePipeline, BytesDoNotDependOnThreads) {
  test::Stage stage(scenario("{}"), "ra_deg,dec_deg,mag_v\n49.7,-5.4,6\n50.2,-5.9,4\n48.9,-6.3,8\n",
                    elements);
  const auto& config = stage.scenario.sensors[0];
  std::string first;
  for (const int count : {1, 2, 4}) {
    Threads threads(count);
    FramePipeline pipeline(
        {.sensor = config, .clock = make_clock(stage.scenario), .digest = "test"}, stage.stars,
        threads);
    const auto frame = pipeline.run(frame_times(config, 2), stage.states);
    const std::string bytes = encode_frame(frame.counts, frame.header);
    if (first.empty()) first = bytes;
    EXPECT_TRUE(bytes == first) << count << " threads";
  }
}

// Stages follow one another: what is a share of one (the shadow's, of the objects) has no time of
// its own in a frame.
TEST(FramePipeline, TellsTheTimeOfEveryStage) {
  test::Stage stage(scenario("{}"), "ra_deg,dec_deg,mag_v\n49.7,-5.4,6\n", elements);
  const auto frame = stage.frame();
  for (const auto& effect : {SkyBackground::facts, StarBackground::facts, SpaceObjects::facts,
                             PointSpread::facts, PhotonNoise::facts, DarkCurrent::facts,
                             ReadNoise::facts, FullWell::facts, Quantisation::facts})
    EXPECT_GT(frame.times[effect], 0.0) << effect.name;
  double sum = frame.detection_s;
  for (const auto& [effect, s] : frame.times.seconds) sum += s;
  EXPECT_LE(sum, frame.total_s * 1.1);
}

}  // namespace
}  // namespace dmise
