#include "sensors/frame/recorded_plans.h"

#include "core/base/error.h"
#include "core/base/files/text_file.h"
#include "tests/pipeline/harness.h"

namespace dmise {
namespace {

class RecordedPlansOfARun : public testing::Test {
 protected:
  RecordedPlansOfARun()
      : stage_(
            "accuracy: draft\nsimulation: {start: 2018-01-21T00:15:00Z, duration_s: 20, tick_s: "
            "5}\n"
            "stars: {catalogue: stars.csv, faintest_mag: 15}\n"
            "sensors: [{name: watch, site: savannah, camera: geo-watch, pointing: zenith, "
            "exposure_s: 1, cadence_s: 10}]\n",
            "ra_deg,dec_deg,mag_v\n49.7,-5.4,6\n") {}

  /// run.json of frames 1 and 2 as the sensor plans them, each with `more` levels.
  std::string run_json(const std::string& sensor = "watch", const std::string& more = "") {
    std::string frames;
    for (std::uint32_t number : {1u, 2u}) {
      std::string levels;
      for (const PlannedEffect& planned : stage_.frame(number).plan.planned)
        levels += (levels.empty() ? "" : ", ") + ("\"" + std::string(planned.facts->name)) +
                  R"(": {"level": ")" + std::string(planned.level_name()) + "\"}";
      if (!more.empty()) levels += ", " + more;  // a key that is there twice has its last value
      frames += (frames.empty() ? "" : ", ") + (R"({"sensor": ")" + sensor) + R"(", "frame": )" +
                std::to_string(number) + R"(, "plan": {"effects": {)" + levels + "}}}";
    }
    return R"({"frames": [)" + frames + "]}";
  }

  /// What is wrong with a run.json of this text; "" if nothing.
  std::string refusal_of(const std::string& text) {
    const std::string path = (stage_.directory / "run.json").string();
    std::ofstream(path) << text;
    scenario_ = stage_.scenario;
    try {
      replay_plans(path, scenario_);
    } catch (const ConfigError& error) {
      const std::string what = error.what();
      EXPECT_EQ(what.rfind(path + ": ", 0), 0u) << what;
      EXPECT_EQ(what.find('\n'), std::string::npos) << what;
      return what.substr(path.size() + 2);
    }
    return "";
  }

  test::Stage stage_;
  Scenario scenario_;
};

TEST_F(RecordedPlansOfARun, AreTakenFrameByFrame) {
  EXPECT_EQ(refusal_of(run_json()), "");
  const RecordedPlans& plans = scenario_.sensors[0].recorded_plans;
  ASSERT_EQ(plans.size(), 2u);
  EXPECT_EQ(plans.at(1).at("photon_noise"), "gaussian");
  EXPECT_EQ(plans.at(1), plans.at(2));
}

TEST_F(RecordedPlansOfARun, MakeFramesWithTheSameBoundsWhateverTheAccuracy) {
  const FrameProducts first = stage_.frame();
  ASSERT_NE(first.header.error, ErrorBound{});
  EXPECT_EQ(first.header.accuracy, "draft");
  ASSERT_EQ(refusal_of(run_json()), "");
  stage_.scenario.sensors = scenario_.sensors;
  for (const Accuracy& accuracy : {draft_accuracy(), reference_accuracy(), Accuracy{}}) {
    stage_.scenario.sensors[0].accuracy = accuracy;
    const FrameProducts replayed = stage_.frame();
    EXPECT_EQ(replayed.header.error, first.header.error) << accuracy.name;
    EXPECT_EQ(replayed.header.accuracy, "replayed");
    EXPECT_EQ(replayed.counts.pixels, first.counts.pixels) << accuracy.name;
  }
}

TEST_F(RecordedPlansOfARun, OfAnotherKindAreRefusedByName) {
  EXPECT_NE(refusal_of(""), "");
  EXPECT_NE(refusal_of("[]"), "");
  EXPECT_NE(refusal_of("{}"), "");
  EXPECT_NE(refusal_of(R"({"frames": 3})"), "");
  EXPECT_NE(refusal_of(R"({"frames": [{"sensor": "watch", "frame": 1, "plan": 3}]})"), "");
  EXPECT_NE(refusal_of(R"({"frames": [{"sensor": "watch", "frame": -1, "plan": {}}]})"), "");
  EXPECT_NE(refusal_of(run_json("other")).find("watch"), std::string::npos);
  EXPECT_NE(refusal_of(run_json("watch", R"("stars": {"level": "v99"})")), "");
  EXPECT_NE(refusal_of(run_json("watch", R"("gravity": {"level": "on"})")).find("gravity"),
            std::string::npos);
}

TEST_F(RecordedPlansOfARun, OfTooFewFramesAreRefusedByTheFirstThatLacks) {
  std::string one = run_json();
  one.replace(one.find(R"("frame": 2)"), 10, R"("frame": 9)");
  EXPECT_NE(refusal_of(one).find("frame 2"), std::string::npos);
}

}  // namespace
}  // namespace dmise
