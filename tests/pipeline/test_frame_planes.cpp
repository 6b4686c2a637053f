#include <cmath>

#include "core/image/fits_file.h"
#include "core/optics/projection.h"
#include "core/photometry/band_parts.h"
#include "tests/pipeline/harness.h"

namespace dmise {
namespace {

const std::string elements =
    "GOES 16\n"
    "1 41866U 16071A   18019.87773469 -.00000245  00000-0  00000-0 0  9992\n"
    "2 41866   0.0069 115.0916 0001074 269.6956 335.2025  1.00271237  4322\n";
const std::string stars = "ra_deg,dec_deg,mag_v,bv\n49.7,-5.4,6,0.65\n";

std::string scenario(const std::string& output) {
  return "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 60, tick_s: 5}\n"
         "objects: [{catalogue: objects.tle}]\nstars: {catalogue: stars.csv, faintest_mag: 15}\n"
         "sensors:\n"
         "  - {name: watch, site: savannah, camera: geo-watch, pointing: {azimuth_deg: 168.7,"
         " elevation_deg: 52}, exposure_s: 5, cadence_s: 10}\n"
         "output: " +
         output + "\n";
}

class Planes : public testing::Test {
 protected:
  test::Stage stage{scenario("{planes: [sources, background, noise], radiance_exr: true,"
                             " saturation: true}"),
                    stars, elements};
  FrameProducts frame(std::uint32_t number = 1, bool noiseless = false) {
    auto& sensor = stage.scenario.sensors[0];
    sensor.camera.optics.columns = 400;
    sensor.camera.optics.rows = 300;
    if (noiseless)
      for (const EffectFacts& e :
           {PhotonNoise::facts, DarkCurrent::facts, ReadNoise::facts, Quantisation::facts})
        sensor.effects.set(e, false);
    return pipeline().run(frame_times(sensor, number), stage.states);
  }
  std::vector<PipelineSettings::Part> radiance_parts;
  FramePipeline pipeline() {
    return FramePipeline({.sensor = stage.scenario.sensors[0],
                          .clock = make_clock(stage.scenario),
                          .digest = "test",
                          .faintest_star_mag = 15,
                          .star_truth = true,
                          .output = stage.scenario.output,
                          .radiance_parts = radiance_parts},
                         stage.stars, stage.threads);
  }
};

TEST_F(Planes, SourcesAndBackgroundAreWhatTheCountsAreDrawnFrom) {
  const auto f = frame(1, true);
  double sources = 0;
  for (std::size_t i = 0; i < f.counts.pixels.size(); ++i) {
    const double rate = f.planes.sources.pixels[i] + f.planes.background.pixels[i];
    ASSERT_NEAR(f.counts.pixels[i], rate * 5, 0.5 + 1e-6 * rate) << i;
    ASSERT_GE(f.planes.sources.pixels[i], 0.0f);
    sources += f.planes.sources.pixels[i];
  }
  double stars_e = 0;
  for (const auto& star : f.stars) stars_e += star.signal_e;
  for (const auto& truth : f.truths) stars_e += truth.rendered_signal_e;
  EXPECT_GT(stars_e, 0);
  EXPECT_NEAR(sources * 5 / stars_e, 1.0, 2e-3);  // single precision on top of the sky
}

// Dark sky at the zenith, V = 21.9 mag/arcsec2. The light of a magnitude is independent of what the
// camera makes of it, so the radiance is that of the sky model in every camera.
TEST_F(Planes, RadianceIsTheSkysWhateverTheCamera) {
  const auto f = frame();
  auto& camera = stage.scenario.sensors[0].camera;
  camera.optics.aperture_m /= 2;
  camera.optics.transmission /= 2;
  camera.detector.quantum_efficiency /= 3;
  const auto g = frame();
  for (const std::size_t i : {0u, 5000u, 119999u})
    EXPECT_NEAR(g.planes.radiance.pixels[i] / f.planes.radiance.pixels[i], 1.0, 1e-5);
  // 1 / arcsec2 is 4.2545e10 / sr; a V = 0 star gives 8.75e9 photons/s/m2 in V (physics of
  // magnitudes, to 1 %); this band is 0.128 um wide, V's equivalent width is 0.09: within a factor.
  const double v = 8.75e9 * std::pow(10, -0.4 * 21.9) * 4.2545e10;
  EXPECT_GT(f.planes.radiance.pixels[0], v * 0.8);
  EXPECT_LT(f.planes.radiance.pixels[0], v * 2.5);
}

// Each part of the band has its light, and together they have the band's: sky, stars and objects.
TEST_F(Planes, RadianceInPartsOfTheBandSumsToTheBands) {
  const auto& band = stage.scenario.sensors[0].camera.band;
  for (const Band& part : parts_of(band, 4))
    radiance_parts.push_back(
        {part, std::make_shared<const ObjectShapes>(stage.scenario.own_objects, part)});
  for (const bool opengl : {false, true}) {
    stage.scenario.sensors[0].effects.set_snapshots(opengl ? 4 : 0);
    stage.scenario.sensors[0].effects.draw_by_opengl(opengl);
    const auto f = frame();
    ASSERT_EQ(f.planes.radiance_parts.size(), 4u);
    double worst = 0, brightest = 0;
    for (std::size_t i = 0; i < f.planes.radiance.pixels.size(); ++i) {
      double sum = 0;
      for (const auto& part : f.planes.radiance_parts) {
        ASSERT_GT(part.map.pixels[i], 0.0f);
        sum += part.map.pixels[i];
      }
      worst = std::max(worst, std::abs(sum / f.planes.radiance.pixels[i] - 1.0));
      brightest = std::max<double>(brightest, f.planes.radiance.pixels[i]);
    }
    EXPECT_GT(brightest, 3 * f.planes.radiance.pixels[0]);  // there is a star
    EXPECT_LT(worst, 0.005) << opengl;
  }
}

TEST_F(Planes, NoiseIsThatOfThePlanes) {
  const auto f = frame();
  const auto& d = stage.scenario.sensors[0].camera.detector;
  const std::size_t i = 1234;
  const double light = 5.0 * (f.planes.sources.pixels[i] + f.planes.background.pixels[i]);
  const double variance =
      light + d.dark_e_per_s * 5 + std::pow(d.read_noise_e, 2) + std::pow(d.gain_e_per_dn, 2) / 12;
  EXPECT_NEAR(f.planes.noise.pixels[i] / std::sqrt(variance), 1.0, 1e-4);
}

TEST_F(Planes, AreNotMadeWhenNobodyAsks) {
  stage.scenario.output = {};
  const auto f = frame();
  EXPECT_TRUE(f.planes.sources.pixels.empty() && f.planes.background.pixels.empty() &&
              f.planes.noise.pixels.empty() && f.planes.radiance.pixels.empty());
  EXPECT_TRUE(f.flags.pixels.empty());
}

// A sensor that starts in the middle of a run makes the frames of the look-back first.
TEST_F(Planes, ARejoiningSensorRebuildsItsPersistence) {
  auto& detector = stage.scenario.sensors[0].camera.detector;
  detector.persistence_fraction = 0.05;
  detector.persistence_s = 2;  // a window of two frames
  stage.scenario.sensors[0].camera.optics.columns = 200;
  stage.scenario.sensors[0].camera.optics.rows = 150;
  FramePipeline whole = pipeline();
  for (std::uint32_t number = 1; number <= 6; ++number) {
    const auto times = frame_times(stage.scenario.sensors[0], number);
    const auto f = whole.run(times, stage.states), g = pipeline().run(times, stage.states);
    ASSERT_EQ(f.counts.pixels, g.counts.pixels) << number;
    if (number == 6) {
      detector.persistence_fraction = 0;
      EXPECT_NE(pipeline().run(times, stage.states).counts.pixels, f.counts.pixels);
    }
  }
}

}  // namespace
}  // namespace dmise
