#pragma once
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <memory>
#include <optional>
#include <string>

#include "core/config/make_clock.h"
#include "core/config/scenario.h"
#include "core/optics/projection.h"
#include "core/sky/variables/variable_stars.h"
#include "nodes/environment/environment_actor.h"
#include "orbit-node/orbit_actor.h"
#include "sensors/frame/frame_pipeline.h"
#include "sensors/scene/view.h"

namespace dmise::test {

/// A scenario in a directory of its own, with the states that its actors publish.
class Stage {
 public:
  explicit Stage(const std::string& yaml, const std::string& stars_csv = "",
                 const std::string& elements = "", int thread_count = 1,
                 const std::string& variables = "")
      : threads(thread_count) {
    setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
    directory =
        std::filesystem::path(testing::TempDir()) /
        (std::string("stage-") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(directory);
    // Tests of physics are of all effects, unless they are about accuracy.
    const bool planned = yaml.find("accuracy:") != std::string::npos;
    write("scenario.yaml", planned ? yaml : yaml + "\naccuracy: off\n");
    write("stars.csv", stars_csv);
    write("objects.tle", elements);
    if (!variables.empty()) write("gcvs.txt", variables);
    scenario = load_scenario((directory / "scenario.yaml").string());
    states = StateWindow(scenario.interpolation, scenario.last_tick());
    const Clock clock = make_clock(scenario);
    OrbitActor orbit(scenario, clock, threads);
    EnvironmentActor environment(scenario, clock);
    for (Tick tick = 0; tick <= scenario.last_tick(); ++tick) {
      for (const auto& message : orbit.step(tick, {})) states.add(message.state);
      for (const auto& message : environment.step(tick, {})) states.add(message.state);
    }
    if (!scenario.star_catalogue_path.empty())
      stars = std::make_shared<const StarMap>(load_star_map(scenario.star_catalogue_path));
    if (!scenario.star_variables_path.empty())
      stars = with_variable_stars(stars, scenario.star_variables_path);
  }
  ~Stage() { std::filesystem::remove_all(directory); }

  FrameProducts frame(std::uint32_t number = 1, std::size_t sensor = 0) {
    const auto& config = scenario.sensors.at(sensor);
    FramePipeline pipeline({.sensor = config,
                            .clock = make_clock(scenario),
                            .seed = scenario.seed,
                            .digest = "test",
                            .faintest_star_mag = scenario.faintest_star_mag,
                            .star_truth = true,
                            .shapes = std::make_shared<const ObjectShapes>(
                                scenario.own_objects, config.camera.band, config.effects)},
                           stars, threads);
    return pipeline.run(frame_times(config, number), states);
  }

  std::filesystem::path directory;
  Threads threads;
  Scenario scenario;
  StateWindow states;
  std::shared_ptr<const StarMap> stars;

 private:
  void write(const char* name, const std::string& text) { std::ofstream(directory / name) << text; }
};

/// The first two frames of the first sensor are the same whichever comes first, by any of these
/// numbers of threads.
inline void expect_same_by_threads(Stage& stage, std::initializer_list<int> numbers) {
  const auto second = stage.frame(2).counts.pixels, first = stage.frame(1).counts.pixels;
  EXPECT_NE(first, second);
  auto config = stage.scenario.sensors[0];
  config.detect = false;
  for (const int n : numbers) {
    Threads threads(n);
    FramePipeline pipeline({.sensor = config,
                            .clock = make_clock(stage.scenario),
                            .seed = stage.scenario.seed,
                            .digest = "test",
                            .faintest_star_mag = 15},
                           stage.stars, threads);
    EXPECT_EQ(pipeline.run(frame_times(config, 2), stage.states).counts.pixels, second) << n;
    EXPECT_EQ(pipeline.run(frame_times(config, 1), stage.states).counts.pixels, first) << n;
    EXPECT_EQ(pipeline.run(frame_times(config, 2), stage.states).counts.pixels, second) << n;
  }
}

/// Pixel of an apparent direction (observed: aberration and refraction in it); nothing where the
/// projection has no image.
inline std::optional<PixelPosition> pixel_of(const View& view, const Vec<Gcrs>& apparent,
                                             SimTime t) {
  return project(view.sensor().camera.optics, view.camera_from_gcrs(t) * apparent);
}

/// Centroid of the counts within `radius_px` of a place; the frame must have no background.
inline PixelPosition centroid(const CountImage& counts, PixelPosition at, double radius_px) {
  double sum = 0, sx = 0, sy = 0;
  for (int y = std::max(0, int(at.y_px - radius_px));
       y <= std::min(counts.rows - 1, int(at.y_px + radius_px)); ++y)
    for (int x = std::max(0, int(at.x_px - radius_px));
         x <= std::min(counts.columns - 1, int(at.x_px + radius_px)); ++x) {
      const double c = counts.at(x, y);
      sum += c;
      sx += c * x;
      sy += c * y;
    }
  return sum > 0 ? PixelPosition{sx / sum, sy / sum} : PixelPosition{-1e9, -1e9};
}

}  // namespace dmise::test
