#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/effects/frame_effects.h"
#include "sensors/light/expected_electrons.h"
#include "tests/pipeline/harness.h"

namespace dmise {
namespace {

/// A telescope of 0.4 m that looks at a place near the galactic plane for two seconds.
std::string scenario(const std::string& stars, const std::string& effects,
                     const std::string& more = "") {
  return "simulation: {start: 2018-01-21T03:00:00Z, duration_s: 60, tick_s: 5}\n"
         "stars: {catalogue: stars.csv, faintest_mag: 30" +
         stars + "}\ndetection: off\n" + more +
         "sensors:\n  - name: eye\n"
         "    site: {latitude_deg: 33.777, longitude_deg: -84.398, height_m: 300}\n"
         "    camera: {optics: {projection: gnomonic, columns: 512, rows: 512, "
         "pixel_pitch_m: 15e-6, focal_length_m: 0.88, aperture_m: 0.4, psf_fwhm_px: 2}, detector: "
         "{quantum_efficiency: 0.8, full_well_e: 1.0e+9, gain_e_per_dn: 1}, band: {name: V, "
         "centre_m: "
         "0.55e-6, width_m: 0.09e-6}}\n"
         "    pointing: {ra_deg: 95, dec_deg: 20}\n    sky: dark\n"
         "    exposure_s: 2\n    cadence_s: 60\n"
         "    effects: {photon_noise: off, read_noise: off, scintillation: off" +
         effects + "}\n";
}
const std::string one_star = "ra_deg,dec_deg,mag_v,bv\n95,60,9.2,0.65\n";

/// The expected electrons of a frame, and the stars that were drawn.
struct Light {
  double sum_e = 0.0, stars_e = 0.0, stars_noise_e = 0.0;
  std::size_t stars = 0;
};

Light light_of(const std::string& yaml) {
  test::Stage stage(yaml, one_star);
  const SensorConfig& sensor = stage.scenario.sensors[0];
  const View view(sensor, frame_times(sensor, 1), stage.states);
  const StarLayer layer(sensor, stage.stars, stage.scenario.faintest_star_mag);
  OpticsStage optics(sensor, 1, stage.threads);
  ExpectedElectronImage image(512, 512);
  EffectTimes times;
  std::vector<StarTruth> truth;
  expected_electrons(view, {.stars = &layer, .faintest_star_mag = stage.scenario.faintest_star_mag},
                     optics, image, stage.threads, times, {.stars = &truth});
  Light light{.stars = truth.size()};
  for (const float e : image.pixels) light.sum_e += double(e);
  double square = 0.0;
  for (const auto& star : truth)
    light.stars_e += star.signal_e, square += star.signal_e * star.signal_e;
  light.stars_noise_e = std::sqrt(square);
  return light;
}

// Whether faint stars are drawn or smooth, a field has the same light, within the noise of so many
// stars and 5 % for their colours: a red star has more photons in this band than one like the Sun.
TEST(SyntheticFrames, HaveTheSameLightAtEveryLimit) {
  const auto light = [](const std::string& level) {
    return light_of(scenario(", synthetic_to: 21", ", extinction: off, synthetic_stars: " + level));
  };
  const Light off = light("off"), v16 = light("v16"), all = light("all");
  EXPECT_EQ(off.stars, 0u);
  ASSERT_GT(all.stars, 1000u);
  EXPECT_GT(all.stars, 3 * v16.stars);
  for (const Light& some : {v16, all})
    EXPECT_NEAR(some.sum_e, off.sum_e, 3.5 * some.stars_noise_e + 0.05 * some.stars_e);
  // From one limit to the next bright stars are the same.
  const double between_e = all.stars_e - v16.stars_e;
  EXPECT_NEAR(all.sum_e, v16.sum_e, 0.1 * between_e);
}

TEST(SyntheticFrames, AStarIsMarkedAndIsTheSameInEveryFrame) {
  test::Stage stage(scenario(", synthetic_to: 18", ""), one_star);
  test::Stage other(scenario(", synthetic_to: 18", "", "") + "\n", one_star);
  other.scenario.seed = 99;
  const FrameProducts a = stage.frame(), b = other.frame();
  ASSERT_GT(a.stars.size(), 50u);
  ASSERT_EQ(a.stars.size(), b.stars.size());
  for (std::size_t i = 0; i < a.stars.size(); ++i) {
    EXPECT_TRUE(a.stars[i].id & synthetic_star_bit);
    EXPECT_EQ(a.stars[i].id, b.stars[i].id);
    EXPECT_EQ(a.stars[i].v_mag, b.stars[i].v_mag);
  }
}

// Stars to V = 9 where the catalogue goes on to 9.5: the same bytes as without.
TEST(SyntheticFrames, ALimitBrighterThanTheCatalogueChangesNothing) {
  test::Stage with(scenario(", synthetic_to: 9", ""), one_star);
  test::Stage without(scenario("", ""), one_star);
  const FrameProducts a = with.frame(), b = without.frame();
  EXPECT_TRUE(a.counts.pixels == b.counts.pixels);
  EXPECT_EQ(a.report.stars_rendered, b.report.stars_rendered);
}

// What the camera can't see is not made: by day none, by night no more than the limit asks for.
TEST(SyntheticFrames, APlanStopsAtWhatTheCameraSees) {
  const auto level = [](const FrameProducts& f) {
    return SyntheticBackground::limit_v_mag(f.plan.effects.level(SyntheticBackground::facts));
  };
  const std::string planned = "accuracy: standard\n";
  test::Stage narrow(scenario(", synthetic_to: 21", "", planned), one_star);
  const double seen = level(narrow.frame());
  EXPECT_GE(seen, 14.0);
  std::string wide = scenario(", synthetic_to: 21", "", planned);
  wide.replace(wide.find("focal_length_m: 0.88, aperture_m: 0.4"), 37,
               "focal_length_m: 0.01, aperture_m: 0.005");
  test::Stage all_sky(wide, one_star);
  EXPECT_LE(level(all_sky.frame()), 13.0);
}

// A plan that finds no star of the catalogue in the field, and little light in the smooth
// starlight beside the noise, draws those beyond it.
TEST(SyntheticFrames, AreInAFieldWithoutAStarOfTheCatalogue) {
  std::string brief = scenario(", synthetic_to: limit", "", "accuracy: standard\n");
  brief.replace(brief.find("exposure_s: 2\n"), 14, "exposure_s: 0.1\n");
  brief.replace(brief.find("read_noise: off"), 15, "read_noise: on");
  brief.replace(brief.find("gain_e_per_dn: 1}"), 17, "gain_e_per_dn: 1, read_noise_e: 9}");
  brief.replace(brief.find("ra_deg: 95, dec_deg: 20"), 23, "ra_deg: 190, dec_deg: 27");
  test::Stage stage(brief, one_star);
  EXPECT_GT(stage.frame().stars.size(), 5u);
}

// In orbit, where a star keeps its place, snapshots have each star where its path has it.
TEST(SyntheticFrames, InSnapshotsHaveTheirOwnPlaces) {
  const auto stars_of = [](const std::string& integration) {
    std::string yaml = scenario(", synthetic_to: 17", integration);
    const std::size_t place = yaml.find("    site: "), end = yaml.find('\n', place);
    yaml.replace(place, end - place, "    platform: bus");
    yaml.replace(yaml.find("sky: dark"), 9, "sky: space");
    yaml += "objects:\n  - name: bus\n    motion: {fixed: {gcrs_m: [-42000000, 0, 0]}}\n";
    return test::Stage(yaml, one_star).frame().stars;
  };
  const auto along_paths = stars_of("");
  const auto in_snapshots = stars_of(", integration: snapshots, snapshots: 4");
  ASSERT_GT(along_paths.size(), 50u);
  ASSERT_EQ(in_snapshots.size(), along_paths.size());
  for (std::size_t i = 0; i < along_paths.size(); ++i) {
    ASSERT_EQ(in_snapshots[i].id, along_paths[i].id);
    EXPECT_NEAR(in_snapshots[i].x_px, along_paths[i].x_px, 0.01);
    EXPECT_NEAR(in_snapshots[i].y_px, along_paths[i].y_px, 0.01);
    EXPECT_NEAR(in_snapshots[i].signal_e, along_paths[i].signal_e, 1e-3 * along_paths[i].signal_e);
  }
}

// The limit of a frame is where stars drown: they end within a magnitude of the faintest that has
// 2.5 times its noise, also without a plan, and the whole sky is not drawn to V = 21.
TEST(SyntheticFrames, EndAtTheLimitOfTheFrame) {
  for (const char* accuracy : {"", "accuracy: standard\n", "accuracy: reference\n"}) {
    test::Stage narrow(scenario(", synthetic_to: limit", "", accuracy), one_star);
    const FrameProducts frame = narrow.frame();
    const double limit =
        SyntheticBackground::limit_v_mag(frame.plan.effects.level(SyntheticBackground::facts));
    EXPECT_GE(limit, 15.0) << accuracy;
    EXPECT_LE(limit, 20.0) << accuracy;
    ASSERT_GT(frame.stars.size(), 50u);
    double faintest = 0.0, faintest_e = 0.0;
    for (const auto& star : frame.stars)
      if (star.v_mag > faintest) faintest = star.v_mag, faintest_e = star.signal_e;
    EXPECT_LE(faintest, limit);
    // Closed form: the root of the sum of squares of a Gaussian of 2 px with its pixel, and the
    // noise of the frame's level. Colours of stars differ by a tenth.
    auto counts = frame.counts.pixels;
    std::ranges::nth_element(counts, counts.begin() + std::ptrdiff_t(counts.size() / 2));
    const double noise_e = std::sqrt(double(counts[counts.size() / 2]));
    const double snr = faintest_e * 0.3145 / noise_e;
    EXPECT_LT(snr, 2.75) << accuracy;
    EXPECT_GT(snr, 0.6) << accuracy;
  }
  std::string wide = scenario(", synthetic_to: limit", "");
  wide.replace(wide.find("focal_length_m: 0.88, aperture_m: 0.4"), 37,
               "focal_length_m: 0.01, aperture_m: 0.005");
  test::Stage all_sky(wide, one_star);
  const FrameProducts frame = all_sky.frame();
  EXPECT_LE(SyntheticBackground::limit_v_mag(frame.plan.effects.level(SyntheticBackground::facts)),
            13.0);
}

TEST(SyntheticFrames, OfTheGalacticCentreAndThePoleAreDrawn) {
  for (const char* at : {"{ra_deg: 266.4, dec_deg: -28.9}", "{ra_deg: 0, dec_deg: 90}",
                         "{ra_deg: 192.86, dec_deg: 27.13}"}) {
    std::string yaml = scenario(", synthetic_to: 19", "");
    yaml.replace(yaml.find("{ra_deg: 95, dec_deg: 20}"), 25, at);
    yaml.replace(yaml.find("2018-01-21T03:00:00Z"), 20, "2018-06-20T05:00:00Z");
    test::Stage stage(yaml, one_star);
    const FrameProducts frame = stage.frame();
    EXPECT_GT(frame.stars.size(), 100u) << at;
    for (const auto& star : frame.stars) {
      EXPECT_TRUE(std::isfinite(star.signal_e));
      EXPECT_LE(star.v_mag, 19.0);
    }
  }
}

}  // namespace
}  // namespace dmise
