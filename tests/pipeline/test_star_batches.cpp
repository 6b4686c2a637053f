#include <algorithm>
#include <cmath>
#include <random>

#include "core/base/units.h"
#include "core/effects/frame_effects.h"
#include "sensors/light/star_layer.h"
#include "tests/pipeline/harness.h"

namespace dmise {
namespace {

const std::string scenario =
    "simulation: {start: 2018-01-21T03:00:00Z, duration_s: 60, tick_s: 5}\n"
    "sensors:\n  - name: eye\n"
    "    site: {latitude_deg: 33.777, longitude_deg: -84.398, height_m: 300}\n"
    "    camera: {optics: {projection: gnomonic, columns: 1200, rows: 900, pixel_pitch_m: 5.4e-6, "
    "focal_length_m: 0.009, aperture_m: 0.0375, equivalent_aperture: true, psf_fwhm_px: 1.5}, "
    "detector: {quantum_efficiency: 0.43, full_well_e: 25500, gain_e_per_dn: 0.35}, "
    "band: {name: V, centre_m: 0.55e-6, width_m: 0.128e-6}}\n"
    "    pointing: zenith\n    sky: dark\n    exposure_s: 20\n    cadence_s: 60\n";

/// A large catalogue, of which so many stars are bright; the others are on the other side.
struct Catalogues {
  static constexpr std::size_t bright = 30000;
  std::shared_ptr<const StarMap> large, of_bright;

  explicit Catalogues(const Vec<Gcrs>& zenith) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> uniform(0, 1);
    std::normal_distribution<double> normal;
    StarCatalogue all, few;
    for (std::uint32_t id = 1; id <= max_stars_at_once + 100; ++id) {
      StarRecord star{.id = id, .v_mag = 13.0, .bv = 2.4 * uniform(random) - 0.4};
      Vec<Gcrs> at = -zenith;
      if (id <= bright) {
        at = unit(zenith + 0.45 * Vec<Gcrs>{normal(random), normal(random), normal(random)});
        star.v_mag = std::max(-1.4, 11.5 + 1.5 * std::log(1.0 - uniform(random)));
        star.pm_ra_cosdec_rad_per_yr = 1e-3 / 3600 * deg * normal(random);
        star.pm_dec_rad_per_yr = 1e-1 / 3600 * deg * normal(random);
        star.parallax_rad = 1e-2 / 3600 * deg * uniform(random);
      }
      const auto [ra, dec] = to_spherical(at);
      star.ra_rad = ra, star.dec_rad = dec;
      append_star(all, star);
      if (id <= bright) append_star(few, star);
    }
    large = std::make_shared<const StarMap>(star_map_of(std::move(all)));
    of_bright = std::make_shared<const StarMap>(star_map_of(std::move(few)));
  }
};

struct Drawn {
  ExpectedElectronImage image{1200, 900};
  std::vector<StarTruth> truth;
  std::uint32_t stars = 0;
};

Drawn draw(const View& view, const std::shared_ptr<const StarMap>& map, bool with_truth,
           int thread_count = 1) {
  Threads threads(thread_count);
  const StarLayer layer(view.sensor(), map, 12.0);
  OpticsStage optics(view.sensor(), 1, threads);
  constexpr double limit_e = 200.0;  // ten times a pixel's noise
  optics.begin(view.times(), limit_e);
  Drawn drawn;
  EffectTimes times;
  drawn.stars = layer.draw(view, optics, OcclusionMask(1200, 900), drawn.image, 12.0,
                           with_truth ? &drawn.truth : nullptr, times);
  std::ranges::sort(drawn.truth, {}, &StarTruth::id);
  return drawn;
}

// Reference: the same stars of a small catalogue, each placed, lit and laid exactly.
TEST(StarBatches, AreTheLightOfStarsOneByOne) {
  test::Stage stage(scenario);
  const SensorConfig& sensor = stage.scenario.sensors[0];
  const View view(sensor, frame_times(sensor, 1), stage.states);
  const Catalogues catalogues(view.up(view.times().middle));
  ASSERT_TRUE(catalogues.of_bright->is_small() && !catalogues.large->is_small());
  const Drawn exact = draw(view, catalogues.of_bright, true),
              many = draw(view, catalogues.large, true);
  ASSERT_GT(exact.stars, 8000u);
  EXPECT_NE(many.image.pixels, exact.image.pixels);  // the batches are at work
  EXPECT_EQ(many.stars, exact.stars);
  ASSERT_EQ(many.truth.size(), exact.truth.size());
  for (std::size_t i = 0; i < exact.truth.size(); ++i) {
    const StarTruth &a = many.truth[i], &b = exact.truth[i];
    ASSERT_EQ(a.id, b.id);
    EXPECT_NEAR(a.signal_e, b.signal_e, 1e-4 * b.signal_e + 1e-3);
    // The path, and the centroid of what is well within the frame.
    for (const auto& [p, q] : {std::pair{a.start, b.start}, {a.middle, b.middle}, {a.end, b.end}})
      EXPECT_LT(std::hypot(p.x_px - q.x_px, p.y_px - q.y_px), 2e-4);
    if (b.x_px < 6 || b.y_px < 6 || b.x_px > 1193 || b.y_px > 893) continue;
    EXPECT_LT(std::hypot(a.x_px - b.x_px, a.y_px - b.y_px), 2e-4);
  }
  // Within 0.01 of a pixel's noise of 20 e- and light, and of a star that saturates 1e-4 of it.
  double worst_sigmas = 0.0, worst_e = 0.0;
  for (std::size_t i = 0; i < exact.image.pixels.size(); ++i) {
    const double e = exact.image.pixels[i], differs_e = std::abs(many.image.pixels[i] - e);
    EXPECT_LT(differs_e, 0.01 * std::sqrt(400.0 + e) + (e > 25500.0 ? 1e-4 * e : 0.0)) << e;
    if (e > 25500.0) continue;
    worst_e = std::max(worst_e, differs_e);
    worst_sigmas = std::max(worst_sigmas, differs_e / std::sqrt(400.0 + e));
  }
  RecordProperty("worst_e", std::to_string(worst_e));
  RecordProperty("worst_sigmas", std::to_string(worst_sigmas));
}

// From space, with the Earth's limb through the middle of the field.
TEST(StarBatches, StarsBehindTheEarthsLimbAreDimmedOneByOneAndTogether) {
  const double r_m = 7e6, limb_deg = 180.0 - std::asin(6.39e6 / r_m) / deg;
  std::string text = scenario;
  const auto put = [&](const std::string& what, const std::string& with) {
    text.replace(text.find(what), what.size(), with);
  };
  put("site: {latitude_deg: 33.777, longitude_deg: -84.398, height_m: 300}", "platform: platform");
  put("pointing: zenith", "pointing: {ra_deg: " + std::to_string(limb_deg) + ", dec_deg: 0}");
  put("sensors:",
      "objects:\n  - name: platform\n    motion: {fixed: {gcrs_m: [7000000, 0, 0]}}\nsensors:");
  test::Stage stage(text);
  const SensorConfig& sensor = stage.scenario.sensors[0];
  const View view(sensor, frame_times(sensor, 1), stage.states);
  ASSERT_TRUE(view.scene().limb_in_field);
  const Catalogues catalogues(view.camera_from_gcrs(view.times().middle).inverse() *
                              Vec<CameraFrame>{0, 0, 1});
  const Drawn exact = draw(view, catalogues.of_bright, true),
              many = draw(view, catalogues.large, true);
  ASSERT_GT(exact.truth.size(), 3000u);
  ASSERT_EQ(many.truth.size(), exact.truth.size());
  const double full_e = view.sensor().camera.optics.collecting_area_m2();
  int dimmed = 0;
  for (std::size_t i = 0; i < exact.truth.size(); ++i) {
    const StarTruth &a = many.truth[i], &b = exact.truth[i];
    ASSERT_EQ(a.id, b.id);
    EXPECT_NEAR(a.signal_e, b.signal_e, 2e-3 * b.signal_e + 1e-3);
    const double alone_e =
        StarLight(sensor.camera.band).photons_per_s_m2(b.v_mag, b.bv) * full_e * 0.43 * 20;
    dimmed += b.signal_e < 0.5 * alone_e && b.x_px > 100 && b.x_px < 1100;
  }
  EXPECT_GT(dimmed, 10);
}

TEST(StarBatches, AreTheSameBytesWithoutTruthAndOnAnyNumberOfThreads) {
  test::Stage stage(scenario);
  const SensorConfig& sensor = stage.scenario.sensors[0];
  const View view(sensor, frame_times(sensor, 1), stage.states);
  const Catalogues catalogues(view.up(view.times().middle));
  const Drawn reference = draw(view, catalogues.large, true);
  for (const int threads : {1, 3}) {
    const Drawn other = draw(view, catalogues.large, false, threads);
    EXPECT_EQ(other.image.pixels, reference.image.pixels) << threads;
    EXPECT_EQ(other.stars, reference.stars) << threads;
  }
}

}  // namespace
}  // namespace dmise
