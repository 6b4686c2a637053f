#include "sensors/scene/gl_evaluator.h"

#include <cmath>
#include <numeric>

#include "core/base/error.h"
#include "core/image/fits_file.h"
#include "tests/pipeline/harness.h"
#include "tests/support/projections.h"

namespace dmise::test {
namespace {

/// Nothing but the light of sources.
const std::string effects =
    "effects: {sky: off, planets: off, photon_noise: off, dark_current: off, read_noise: off, "
    "full_well: off,"
    " quantisation: off, scintillation: off, shadow: off}\n";

const std::string detector =
    "    detector: {full_well_e: 1.0e+9, gain_e_per_dn: 10, adc_bits: 16}\n"
    "    band: {name: V, centre_m: 0.55e-6, width_m: 0.1e-6}\n";

std::string camera(const std::string& projection, double field_deg, const std::string& more = "") {
  return "    optics: {projection: " + projection +
         ", columns: 200, rows: 200, pixel_pitch_m: 1.0e-5, field_of_view_deg: " +
         std::to_string(field_deg) + ", aperture_m: 3.0e-4" + more + "}\n" + detector;
}

/// One sensor twice: along the path, and as snapshots by OpenGL.
std::string twice(const std::string& place, const std::string& pointing, double exposure_s,
                  const std::string& camera) {
  std::string text = "sensors:\n";
  for (const std::string name : {"path", "opengl"})
    text += "- name: " + name + "\n  " + place + "\n  pointing: " + pointing +
            "\n  exposure_s: " + std::to_string(exposure_s) +
            "\n  cadence_s: " + std::to_string(exposure_s) +
            (name == "path" ? "" : "\n  effects: {evaluator: opengl}") + "\n  camera:\n" + camera;
  return text;
}

std::string simulation(double duration_s, double tick_s) {
  return "simulation: {start: 2018-01-21T00:15:00Z, duration_s: " + std::to_string(duration_s) +
         ", tick_s: " + std::to_string(tick_s) + ", seed: 1}\n";
}

FrameProducts frame_of(Stage& stage, std::size_t sensor, int snapshots = 0, int threads = 1) {
  SensorConfig config = stage.scenario.sensors.at(sensor);
  config.detect = false;
  if (snapshots) config.effects.set_snapshots(snapshots);
  Threads pool(threads);
  FramePipeline pipeline({.sensor = config,
                          .clock = make_clock(stage.scenario),
                          .digest = "test",
                          .faintest_star_mag = 15,
                          .star_truth = true,
                          .output = {.sources = true, .background = true},
                          .shapes = std::make_shared<const ObjectShapes>(stage.scenario.own_objects,
                                                                         config.camera.band)},
                         stage.stars, pool);
  return pipeline.run(frame_times(config, 1), stage.states);
}

double sum(const ExpectedElectronImage& image) {
  return std::accumulate(image.pixels.begin(), image.pixels.end(), 0.0);
}

/// Light that lies in other pixels, as a share of all.
double misplaced(const ExpectedElectronImage& exact, const ExpectedElectronImage& image) {
  double difference = 0;
  for (std::size_t i = 0; i < exact.pixels.size(); ++i)
    difference += std::abs(double(exact.pixels[i]) - double(image.pixels[i]));
  return difference / sum(exact) / 2;
}

double worst_of_peak(const ExpectedElectronImage& a, const ExpectedElectronImage& b) {
  double worst = 0, peak = 0;
  for (std::size_t i = 0; i < a.pixels.size(); ++i) {
    worst = std::max(worst, std::abs(double(a.pixels[i]) - double(b.pixels[i])));
    peak = std::max(peak, double(a.pixels[i]));
  }
  return worst / peak;
}

struct Field {
  std::string projection;
  double deg;
};

/// Every projection with a wide field.
std::vector<Field> wide_fields() {
  std::vector<Field> all;
  for (const auto& p : test::every_projection)
    all.push_back({p.yaml, p.fields_to_deg < 182 ? 90.0 : 150.0});
  return all;
}
const std::vector<Field> fields = wide_fields();

/// From `first` snapshots on the error falls at least as 1/N, until what is left is `rest`.
void expect_convergence(Stage& stage, int first, double rest, const std::string& what) {
  const ExpectedElectronImage exact = frame_of(stage, 0).planes.sources;
  ASSERT_GT(sum(exact), 0.0) << what;
  double before = 1.0;
  for (int count = first / 2; count <= 32 * first; count *= 2) {
    const ExpectedElectronImage drawn = frame_of(stage, 1, count).planes.sources;
    EXPECT_NEAR(sum(drawn) / sum(exact), 1.0, 1e-3) << what << " " << count;
    const double error = misplaced(exact, drawn);
    if (count >= first) {
      EXPECT_LT(error, std::max(0.5 * before, rest)) << what << " " << count;
    }
    before = error;
  }
  EXPECT_LE(before, rest) << what;
}

// Half an hour of fixed stars: trails of 5 to 30 px, one of them far from the axis.
TEST(GlEvaluator, SnapshotsOfAStarTrailConvergeToThePathAtLeastAsOneOverTheirNumber) {
  for (const Field& field : fields) {
    Stage stage(simulation(1800, 60) + "stars: {catalogue: stars.csv, faintest_mag: 15}\n" +
                    effects +
                    twice("site: savannah", "zenith", 1800, camera(field.projection, field.deg)),
                "ra_deg,dec_deg,mag_v,bv\n44,32,2,0.5\n75,10,2,0.5\n30,60,2,0.5\n");
    ASSERT_GE(frame_of(stage, 0).report.stars_rendered, 2u);
    expect_convergence(stage, 32, 2e-3, field.projection);
  }
}

// A place of the geostationary belt does not move before a camera that stands: one snapshot is
// enough. Before one that keeps to the stars it leaves a trail.
TEST(GlEvaluator, SnapshotsOfAGeostationaryPointAreThePoint) {
  const std::string slot =
      "objects:\n- name: slot\n  motion: {fixed: {latitude_deg: 0, longitude_deg: -75.3, height_m: "
      "35786000}}\n  radius_m: 30\n";
  for (const Field& field : fields) {
    Stage still(simulation(600, 60) + slot + effects +
                twice("site: savannah", "{target: slot, tracking: fixed}", 600,
                      camera(field.projection, field.deg)));
    const ExpectedElectronImage exact = frame_of(still, 0).planes.sources;
    for (const int count : {1, 3, 64}) {
      const ExpectedElectronImage drawn = frame_of(still, 1, count).planes.sources;
      EXPECT_LT(worst_of_peak(exact, drawn), 1e-5) << field.projection << " " << count;
      EXPECT_NEAR(sum(drawn) / sum(exact), 1.0, 1e-5);
    }
    Stage trail(simulation(600, 60) + slot + effects +
                twice("site: savannah", "{target: slot, tracking: sidereal}", 600,
                      camera(field.projection, field.deg / 6)));
    expect_convergence(trail, 32, 2e-3, field.projection);
  }
}

// 100 km before a camera in orbit, crossing at 5 km/s.
TEST(GlEvaluator, SnapshotsOfALowOrbitsStreakConvergeToThePathAtLeastAsOneOverTheirNumber) {
  const auto orbit = [](const std::string& name, int inclination_deg, double anomaly_deg) {
    return "- name: " + name +
           "\n  radius_m: 1\n  motion: {two_body: {semi_major_axis_m: 7178137, "
           "eccentricity: 0, inclination_deg: " +
           std::to_string(inclination_deg) +
           ", raan_deg: 0, true_anomaly_deg: " + std::to_string(anomaly_deg) + "}}\n";
  };
  for (const Field& field : fields) {
    Stage stage(simulation(10, 5) + "objects:\n" + orbit("platform", 98, 0) +
                orbit("leo", 60, 0.8) + effects +
                twice("platform: platform", "{target: leo, tracking: sidereal}", 5,
                      camera(field.projection, field.deg)));
    expect_convergence(stage, 64, 2e-3, field.projection);
  }
}

std::string everything(const std::string& optics, const std::string& evaluators) {
  return simulation(10, 5) +
         "objects:\n- name: platform\n  motion: {two_body: {semi_major_axis_m: 7178137, "
         "eccentricity: 0, inclination_deg: 98.6, raan_deg: 0, true_anomaly_deg: 0}}\n"
         "- name: target\n  motion: {two_body: {semi_major_axis_m: 7178137, eccentricity: 0, "
         "inclination_deg: 98.6, raan_deg: 0, true_anomaly_deg: 0.016}}\n"
         "  attitude: nadir\n  geometry: {model: box-wing}\n"
         "stars: {catalogue: stars.csv, faintest_mag: 15}\n"
         "effects: {photon_noise: off, shadow: off, integration: snapshots, snapshots: 6}\n"
         "sensors:\n" +
         [&] {
           std::string text;
           for (const std::string evaluator : {"analytic", "opengl"})
             text += "- name: " + evaluator +
                     "\n  platform: platform\n  pointing: {target: target}\n  exposure_s: 0.5\n"
                     "  cadence_s: 10\n  sky: space\n  effects: {evaluator: " +
                     evaluator + evaluators + "}\n  camera:\n" + optics + detector;
           return text;
         }();
}

const std::string star = "ra_deg,dec_deg,mag_v\n0,0,3\n";

const std::string telescope =
    "    optics: {columns: 520, rows: 200, pixel_pitch_m: 1.0e-5, focal_length_m: 1, aperture_m: "
    "0.3";

// A resolved satellite, sky and both ways of blurring: the same snapshots, deposited and drawn.
TEST(GlEvaluator, DrawsTheFrameThatTheDepositMakesOfTheSameSnapshots) {
  for (const std::string blur :
       {"}\n", ", psf: diffraction, obscuration: 0.3, method: transform}\n"}) {
    Stage stage(everything(telescope + blur, ""), star);
    const FrameProducts deposited = frame_of(stage, 0), drawn = frame_of(stage, 1);
    ASSERT_TRUE(deposited.truths.at(0).resolved);
    EXPECT_LT(worst_of_peak(deposited.planes.sources, drawn.planes.sources), 2e-5) << blur;
    EXPECT_LT(worst_of_peak(deposited.planes.background, drawn.planes.background), 5e-6) << blur;
    EXPECT_NEAR(sum(drawn.planes.sources) / sum(deposited.planes.sources), 1.0, 1e-5);
    EXPECT_EQ(drawn.truths.at(0).rendered_signal_e, deposited.truths.at(0).rendered_signal_e);
  }
}

TEST(GlEvaluator, BytesDoNotDependOnThreads) {
  Stage stage(everything(telescope + "}\n", ""), star);
  const FrameProducts one = frame_of(stage, 1, 0, 1), four = frame_of(stage, 1, 0, 4);
  EXPECT_TRUE(encode_frame(one.counts, one.header) == encode_frame(four.counts, four.header));
}

TEST(GlEvaluator, TheScenarioAsksForIt) {
  const auto read = [](const std::string& more) {
    return Stage(everything(telescope + "}\n", more), star).scenario.sensors[1].effects;
  };
  EXPECT_TRUE(read("").drawn_by_opengl());
  EXPECT_EQ(read("").snapshots(), 6);
  EXPECT_EQ(read(", snapshots: 40").snapshots(), 40);
  EXPECT_FALSE(EffectSet().drawn_by_opengl());
  const auto complaint = [](const std::string& optics, const std::string& more) {
    try {
      Stage stage(everything(optics, more), star);
      return std::string();
    } catch (const ConfigError& error) {
      return std::string(error.what());
    }
  };
  EXPECT_NE(
      complaint(telescope + "}\n", ", integration: analytic").find("needs integration: snapshots"),
      std::string::npos);
  EXPECT_NE(complaint(telescope + ", psf: diffraction, method: direct}\n", "")
                .find("opengl can't draw the point sources of this camera"),
            std::string::npos);
}

TEST(GlEvaluator, RefusesWhatMoves) {
  GlEvaluator evaluator;
  ExpectedElectronImage image(20, 20);
  Threads one;
  const DepositView view{image.pixels.data(), 20, 20, 20, 0, 0, 20, 20};
  const Arc moves{{5, 5}, {6, 6}, {7, 7}, 1.0}, dark{{5, 5}, {5, 5}, {5, 5}, -1.0};
  EXPECT_THROW(evaluator.add({&moves, 1}, make_psf_table(1), view, one), Error);
  EXPECT_THROW(evaluator.add({&dark, 1}, make_psf_table(1), view, one), Error);
}

bool maps_opengl() {
  std::ifstream file("/proc/self/maps");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  return text.find("libdmise_render") != std::string::npos ||
         text.find("OSMesa") != std::string::npos || text.find("libGL") != std::string::npos;
}

// In a process of its own: others may have drawn in this one.
TEST(GlEvaluatorDeathTest, APlanWithoutItLoadsNoOpenGl) {
  GTEST_FLAG_SET(death_test_style, "threadsafe");
  EXPECT_EXIT(
      {
        Stage stage(everything(telescope + "}\n", ""), star);
        stage.scenario.own_objects.clear();
        const bool before = maps_opengl();
        frame_of(stage, 0);
        const bool analytic = maps_opengl();
        frame_of(stage, 1);
        std::exit(!before && !analytic && maps_opengl() ? 0 : 1);
      },
      testing::ExitedWithCode(0), "");
}

}  // namespace
}  // namespace dmise::test
