#include <fstream>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/products/frame_report.h"
#include "sensors/frame/cue_journal.h"
#include "sensors/frame/sensor_evaluator.h"
#include "sensors/scene/cue_path.h"
#include "tests/pipeline/harness.h"

// A sensor that is cued follows the predicted path of its task, and makes no other exposure.
namespace dmise {
namespace {

const std::string text =
    "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 20, tick_s: 5}\n"
    "objects:\n  - name: leo\n    radius_m: 5\n    motion: {two_body: {epoch: "
    "2018-01-21T00:15:00Z, position_m: [-3340000, 5000000, 4060000], velocity_m_per_s: [-6250, "
    "-4180, 0]}}\n"
    "fusion: {cue_delay_ticks: 1}\n"
    "sensors:\n"
    "  - {name: eye, site: {latitude_deg: 33.7, longitude_deg: -84.4}, camera: {optics: {columns: "
    "200, rows: 200, pixel_pitch_m: 1.0e-5, focal_length_m: 1.0, aperture_m: 0.4}, detector: "
    "{full_well_e: 90000, gain_e_per_dn: 1}, band: {centre_m: 0.55e-6, width_m: 0.1e-6}}, "
    "pointing: {cued: on}, exposure_s: 0.5, cadence_s: 2.5, sky: dark}\n";

/// The path of the object itself.
std::shared_ptr<Task> task_along(const test::Stage& stage, std::uint32_t id, double start_s,
                                 double end_s) {
  auto task = std::make_shared<Task>();
  task->id = id;
  task->sensor = "eye";
  task->track = 1;
  task->start = sim_seconds(start_s);
  task->on_target = sim_seconds(start_s + 1);
  task->end = sim_seconds(end_s);
  task->path_step_s = 5;
  for (int k = 0; k < 5; ++k) {
    const Motion at = stage.states.motion(0, sim_seconds(5.0 * k));
    const Vec<Gcrs>&r = at.position_m, &v = at.slope_m_per_s;
    task->path_m.insert(task->path_m.end(), {r.x, r.y, r.z});
    task->path_m_per_s.insert(task->path_m_per_s.end(), {v.x, v.y, v.z});
  }
  return task;
}

TEST(Cue, TheTargetOfATaskIsInTheMiddleOfTheFrame) {
  test::Stage stage(text);
  stage.states.follow(task_along(stage, 1, 0, 20));
  for (const std::uint32_t frame : {2u, 5u}) {
    const FrameProducts made = stage.frame(frame);
    ASSERT_EQ(made.truths.size(), 1u);
    EXPECT_NEAR(made.truths[0].middle_x_px, 99.5, 0.2);
    EXPECT_NEAR(made.truths[0].middle_y_px, 99.5, 0.2);
    // It moves a degree per second, the mount with it.
    EXPECT_NEAR(made.truths[0].end_x_px, 99.5, 0.5);
    EXPECT_NEAR(made.truths[0].end_y_px, 99.5, 0.5);
  }
}

// Told to look while the Moon is up, which this camera does not do: the frame is dark.
TEST(Cue, ATaskWhereTheShutterIsClosedLeavesADarkFrame) {
  test::Stage stage(text);
  stage.states.follow(task_along(stage, 1, 0, 20));
  stage.scenario.sensors[0].camera.exclusion = {.sun_deg = {},
                                                .moon_deg = 180.0,
                                                .earth_limb_deg = {},
                                                .action = ExclusionAction::close_shutter};
  const FrameProducts made = stage.frame(2);
  EXPECT_TRUE(made.report.shutter_closed && made.report.excluded.moon);
  ASSERT_EQ(made.truths.size(), 1u);
  EXPECT_EQ(made.truths[0].rendered_signal_e, 0.0);
  EXPECT_NEAR(made.truths[0].middle_x_px, 99.5, 0.2);
  EXPECT_TRUE(made.detections.empty());
}

TEST(Cue, WithoutATaskItIsParked) {
  test::Stage stage(text);
  const FrameProducts made = stage.frame(1);
  const SensorConfig& sensor = stage.scenario.sensors[0];
  SensorConfig parked = sensor;
  parked.pointing = std::get<PointCued>(sensor.pointing).park;
  stage.scenario.sensors[0] = parked;
  const FrameProducts fixed = stage.frame(1);
  EXPECT_NEAR(made.report.boresight_ra_rad, fixed.report.boresight_ra_rad, 1e-12);
  EXPECT_NEAR(made.report.boresight_dec_rad, fixed.report.boresight_dec_rad, 1e-12);
}

TEST(Cue, AnExposureIsOfTheTaskThatItLiesIn) {
  test::Stage stage(text);
  const std::vector<std::shared_ptr<const Task>> tasks{task_along(stage, 1, 2, 8),
                                                       task_along(stage, 2, 6, 12)};
  const auto during = [&](double start_s, double end_s) {
    const Task* task = task_during(tasks, sim_seconds(start_s), sim_seconds(end_s));
    return task ? task->id : 0;
  };
  EXPECT_EQ(during(0, 1), 0u);
  EXPECT_EQ(during(2, 2.5), 0u);  // slews
  EXPECT_EQ(during(3, 3.5), 1u);
  EXPECT_EQ(during(5.8, 6.3), 0u);  // the next one begins in it
  EXPECT_EQ(during(6.2, 6.7), 0u);
  EXPECT_EQ(during(7.5, 8), 2u);  // the earlier one ended at 6 s
  EXPECT_EQ(during(11.8, 12.3), 0u);
}

// A process makes the exposures of its tasks, another goes on after 10 s.
TEST(Cue, ASensorThatGoesOnKnowsItsTasks) {
  test::Stage stage(text);
  const Clock clock = make_clock(stage.scenario);
  const auto sensor = [&] {
    const SensorConfig& config = stage.scenario.sensors[0];
    return SensorEvaluator(
        {.sensor = config,
         .clock = clock,
         .digest = "test",
         .shapes = std::make_shared<const ObjectShapes>(stage.scenario.own_objects,
                                                        config.camera.band, config.effects)},
        {.tick_length = stage.scenario.tick, .duration = stage.scenario.duration},
        {.fits = false, .png = false}, nullptr, stage.directory.string() + "/eye", stage.threads);
  };
  const auto inputs = [&](Tick tick) {
    OrbitActor orbit(stage.scenario, clock, stage.threads);
    EnvironmentActor environment(stage.scenario, clock);
    std::vector<Message> all = orbit.step(0, {});
    if (tick > 0)
      std::erase_if(
          all, [](const Message& m) { return std::holds_alternative<ObjectStates>(*m.state); });
    for (const auto& m : tick > 0 ? orbit.step(tick, {}) : std::vector<Message>{}) all.push_back(m);
    for (const auto& m : environment.step(0, {})) all.push_back(m);
    if (tick > 0)
      for (const auto& m : environment.step(tick, {})) all.push_back(m);
    if (tick == 1) {
      TaskSet set{.tick = 0, .time = {}, .node = "fusion-node", .sensor = "eye", .tasks = {}};
      set.tasks.push_back(*task_along(stage, 1, 5, 18));
      all.push_back({"task/eye", 0, std::make_shared<State>(set)});
    }
    return all;
  };
  std::vector<std::uint32_t> frames;
  const auto step = [&](SensorEvaluator& eye, Tick tick) {
    for (const Message& m : eye.step(tick, inputs(tick)))
      if (const auto* report = std::get_if<FrameReport>(m.state.get()))
        frames.push_back(report->frame);
  };
  SensorEvaluator first = sensor();
  EXPECT_EQ(first.consumes().back(), "task/eye");
  EXPECT_EQ(first.delay("task/eye"), 1);
  EXPECT_EQ(first.delay("env/common"), 0);
  EXPECT_FALSE(first.needs("task/eye"));
  for (Tick tick = 0; tick <= 2; ++tick) step(first, tick);
  EXPECT_EQ(frames, (std::vector<std::uint32_t>{4}));  // begun at 7.5 s
  EXPECT_EQ(CueJournal::ticks_done(stage.directory.string() + "/eye"), 3);
  SensorEvaluator second = sensor();
  second.resume(3, inputs(2));
  for (Tick tick = 3; tick <= 4; ++tick) step(second, tick);
  EXPECT_EQ(frames, (std::vector<std::uint32_t>{4, 5, 6, 7, 8}));  // to 17.5 s
}

TEST(CueJournal, LeavesOutALineThatWasCutOff) {
  test::Stage stage(text);
  const std::string directory = stage.directory.string() + "/eye";
  {
    CueJournal journal(directory);
    journal.clear();
    journal.add(*task_along(stage, 3, 2, 8));
    journal.end(0);
    journal.end(1);
  }
  std::ofstream(directory + "/tasks.journal", std::ios::app) << "task 4 1 0 20000";
  EXPECT_EQ(CueJournal::ticks_done(directory), 2);
  CueJournal journal(directory);
  const auto tasks = journal.resume();
  ASSERT_EQ(tasks.size(), 1u);
  const auto whole = task_along(stage, 3, 2, 8);
  EXPECT_EQ(tasks[0]->id, 3u);
  EXPECT_EQ(tasks[0]->on_target, whole->on_target);
  EXPECT_EQ(tasks[0]->path_m, whole->path_m);
  EXPECT_EQ(tasks[0]->path_m_per_s, whole->path_m_per_s);
  journal.end(2);
  EXPECT_EQ(CueJournal::ticks_done(directory), 3);
}

TEST(CueJournal, RefusesWhatIsNoJournal) {
  test::Stage stage(text);
  const std::string directory = stage.directory.string();
  std::ofstream(directory + "/tasks.journal") << "task 4 1 nonsense\n";
  CueJournal journal(directory);
  EXPECT_THROW(journal.resume(), Error);
}

}  // namespace
}  // namespace dmise
