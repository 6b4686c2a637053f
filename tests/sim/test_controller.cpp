#include "core/sim/controller.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace dmise {
namespace {

/// Publishes its tick on its own topic and notes what it was given.
class Echo : public Participant {
 public:
  Echo(std::string name, std::vector<std::string> consumes, std::vector<std::string>& log)
      : name_(std::move(name)), consumes_(std::move(consumes)), log_(log) {}
  std::string name() const override { return name_; }
  std::vector<std::string> produces() const override { return {"topic/" + name_}; }
  std::vector<std::string> consumes() const override { return consumes_; }
  Tick delay(const std::string& topic) const override { return topic == late_ ? 2 : 0; }
  void hear_late(std::string topic) { late_ = std::move(topic); }
  std::vector<Message> resume(Tick tick, std::span<const Message> past) override {
    std::string line = name_ + " resumes at " + std::to_string(tick) + ":";
    for (const auto& m : past) line += " " + m.topic + "@" + std::to_string(m.tick);
    log_.push_back(line);
    return {};
  }
  std::vector<Message> step(Tick tick, std::span<const Message> inputs) override {
    std::string line = name_ + std::to_string(tick) + ":";
    for (const auto& m : inputs) line += " " + m.topic + "@" + std::to_string(m.tick);
    log_.push_back(line);
    return {{"topic/" + name_, tick, std::make_shared<State>(ObjectRoster{})}};
  }

 private:
  std::string name_;
  std::vector<std::string> consumes_;
  std::string late_;
  std::vector<std::string>& log_;
};

std::vector<std::unique_ptr<Participant>> pair(std::vector<std::string>& log,
                                               std::vector<std::string> camera_consumes,
                                               std::vector<std::string> orbit_consumes = {}) {
  std::vector<std::unique_ptr<Participant>> list;
  list.push_back(std::make_unique<Echo>("camera", std::move(camera_consumes), log));
  list.push_back(std::make_unique<Echo>("orbit", std::move(orbit_consumes), log));
  return list;
}

TEST(SimulationController, RunsProducersBeforeConsumersInEveryTick) {
  std::vector<std::string> log;
  SimulationController(pair(log, {"topic/orbit"})).run(1, [](Tick) { return true; });
  EXPECT_EQ(log, (std::vector<std::string>{"orbit0:", "camera0: topic/orbit@0",
                                           "orbit1:", "camera1: topic/orbit@1"}));
}

TEST(SimulationController, StopsWhenAskedAfterATick) {
  std::vector<std::string> log;
  SimulationController(pair(log, {})).run(9, [](Tick tick) { return tick < 1; });
  EXPECT_EQ(log.size(), 4u);
}

std::vector<std::unique_ptr<Participant>> loop(std::vector<std::string>& log) {
  auto camera = std::make_unique<Echo>("camera", std::vector<std::string>{"topic/tasks"}, log);
  camera->hear_late("topic/tasks");
  std::vector<std::unique_ptr<Participant>> list;
  list.push_back(std::make_unique<Echo>("tasks", std::vector<std::string>{"topic/camera"}, log));
  list.push_back(std::move(camera));
  return list;
}

TEST(SimulationController, ATopicWithADelayClosesALoop) {
  std::vector<std::string> log;
  SimulationController(loop(log)).run(3, [](Tick) { return true; });
  EXPECT_EQ(log, (std::vector<std::string>{"camera0:", "tasks0: topic/camera@0",  //
                                           "camera1:", "tasks1: topic/camera@1",
                                           "camera2: topic/tasks@0", "tasks2: topic/camera@2",
                                           "camera3: topic/tasks@1", "tasks3: topic/camera@3"}));
}

TEST(SimulationController, ALoopThatGoesOnDoesTheTicksOfItsDelayAgain) {
  std::vector<std::string> log;
  SimulationController(loop(log)).run(
      7, [](Tick) { return true; }, 6);
  EXPECT_EQ(log,
            (std::vector<std::string>{
                "camera resumes at 4:", "camera4:", "tasks resumes at 4:", "tasks4: topic/camera@4",
                "camera5:", "tasks5: topic/camera@5", "camera6: topic/tasks@4",
                "tasks6: topic/camera@6", "camera7: topic/tasks@5", "tasks7: topic/camera@7"}));
}

TEST(SimulationController, RefusesWhatCanNeverRun) {
  std::vector<std::string> log;
  EXPECT_THROW(SimulationController(pair(log, {"topic/nobody"})), Error);
  EXPECT_THROW(SimulationController(pair(log, {"topic/orbit"}, {"topic/camera"})), Error);
}

}  // namespace
}  // namespace dmise
