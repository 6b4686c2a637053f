#pragma once
#include <cmath>
#include <cstdio>
#include <string>

#include "core/base/units.h"
#include "tests/pipeline/wiring.h"

// Scenes with Sun, Moon and Earth in the field or beside it.
namespace dmise::test {

/// Expected electrons a second of sky, discs and stray light.
inline ExpectedElectronImage light_of(const Stage& stage, Threads& threads) {
  const auto& config = stage.scenario.sensors.at(0);
  OutputConfig output;
  output.background = true;
  FramePipeline pipeline({.sensor = config,
                          .clock = make_clock(stage.scenario),
                          .seed = 1,
                          .digest = "test",
                          .output = output,
                          .shapes = std::make_shared<const ObjectShapes>(
                              stage.scenario.own_objects, config.camera.band, config.effects)},
                         nullptr, threads);
  return pipeline.run(frame_times(config, 1), stage.states).planes.background;
}
inline ExpectedElectronImage light_of(Stage& stage) { return light_of(stage, stage.threads); }

inline double sum_of(const ExpectedElectronImage& image) {
  double sum = 0;
  for (const float e : image.pixels) sum += e;
  return sum;
}
inline void expect_finite(const ExpectedElectronImage& image) {
  for (const float e : image.pixels) ASSERT_TRUE(std::isfinite(e) && e >= 0.0f);
}

/// Electrons a second for a photon/s/m2.
inline double area_m2(const Stage& stage) {
  const Camera& camera = stage.scenario.sensors[0].camera;
  return pi / 4 * camera.optics.aperture_m * camera.optics.aperture_m * camera.optics.transmission *
         camera.detector.quantum_efficiency;
}

inline std::string more(const std::string& effects = "") {
  return ", sky: dark, detection: off, effects: {" + noiseless + effects + "}";
}

/// Without the light of the Earth's air.
inline const std::string no_air = ", limb_air: off, limb_airglow: off";

inline std::string radec(double ra_deg, double dec_deg) {
  char text[96];
  std::snprintf(text, sizeof text, "{ra_deg: %.8f, dec_deg: %.8f}", ra_deg, dec_deg);
  return text;
}
inline std::string towards(const Vec<Gcrs>& direction) {
  const auto [ra, dec] = to_spherical(direction);
  return radec(ra / deg, dec / deg);
}

/// A camera that stands at a place in space.
inline std::string in_space(const Vec<Gcrs>& at_m, const std::string& pointing,
                            const std::string& camera, const std::string& effects = "",
                            const std::string& objects = "", const std::string& simulation = "",
                            const std::string& start = "2018-01-21T00:15:00Z") {
  char platform[160];
  std::snprintf(platform, sizeof platform,
                "objects:\n  - name: platform\n    motion: {fixed: {gcrs_m: [%.3f, %.3f, %.3f]}}\n",
                at_m.x, at_m.y, at_m.z);
  return scenario(start, 5, "platform: platform", camera, pointing, 0.01, 5, more(effects),
                  simulation, platform + objects);
}

/// Sun, Moon and axes at that start.
inline const EnvironmentState& bodies() {
  static const Stage stage(
      in_space({4.2e7, 1e6, 2e6}, "{ra_deg: 0, dec_deg: 0}", camera(8, 8, 0.1)));
  static const EnvironmentState environment = stage.states.environment({0});
  return environment;
}

}  // namespace dmise::test
