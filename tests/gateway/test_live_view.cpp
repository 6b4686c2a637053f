// What viewers are told of a run.
#include "core/products/frame_report.h"
#include "nodes/gateway/live_view.h"

#include <erfa.h>
#include <gtest/gtest.h>

#include <cstdio>
#include <cstring>
#include <ctime>
#include <nlohmann/json.hpp>

#include "core/time/clock.h"
#include "core/time/iso8601.h"
#include "nodes/wire/receiver.h"
#include "nodes/wire/state_codec.h"
#include "tests/wire/examples.h"

namespace dmise {
namespace {

using Json = nlohmann::json;

/// A view, and what viewers are told by it.
struct LiveViewTest : testing::Test {
  /// Null before the first message.
  Json told(MessageSlot slot) const {
    const auto message = latest.of(slot);
    return message ? Json::parse(message->bytes) : Json();
  }
  /// Directions and places can be told from here on.
  void turn_the_earth() {
    EnvironmentState environment;
    environment.earth = earth_orientation(Clock(parse_utc("2018-01-21T00:15:00Z")), {});
    view.take(State(environment));
  }

  LatestMessages latest;
  ViewHistory history;
  LiveView view{latest, history};
};

/// One object that is seen, one that is not.
TruthSet truth_of(std::uint32_t frame) {
  TruthSet set{.sensor = "alpha", .frame = frame, .truths = {{}, {}}};
  set.truths[0] = {.name = "SECRET", .start_x_px = 3.5, .end_y_px = 7.25, .in_frame = true};
  set.truths[1].name = "OUTSIDE";
  return set;
}

// Reference: ERFA, eraC2t06a: the rotation from GCRS to ITRS. float32 of 42,000 km has steps of 4
// m.
TEST(ObjectsMessage, PositionsAreEarthFixedToTheStepOfTheirNumbers) {
  const Clock clock(parse_utc("2018-01-21T00:15:00Z"));
  const SimTime t = sim_seconds(3000.0);
  ObjectStates states{.tick = 600, .time = t, .count = 3};
  states.position_m = {42'164e3, 7000e3, 0, 1e3, -2000e3, 0, -5e5, 1500e3, 0};
  states.code = {0, 0, 7};
  const std::string bytes =
      encode_objects(states, earth_orientation(clock, sim_seconds(2990)), 5.0);
  ASSERT_EQ(bytes.size(), objects_header_bytes + 36);
  EXPECT_EQ(bytes.substr(0, 4), "DMOB");
  std::uint32_t count = 0;
  double header[2];
  float km[9];
  std::memcpy(&count, bytes.data() + 4, 4);
  std::memcpy(header, bytes.data() + 8, 16);
  std::memcpy(km, bytes.data() + objects_header_bytes, 36);
  EXPECT_EQ(count, 3u);
  EXPECT_EQ(header[0], 3000.0);
  EXPECT_EQ(header[1], 5.0);
  double itrs_from_gcrs[3][3];
  const Tt tt = clock.tt(t);
  const Ut1 ut1 = clock.ut1(t);
  eraC2t06a(tt.jd1, tt.jd2, ut1.jd1, ut1.jd2, 0.0, 0.0, itrs_from_gcrs);
  for (int object = 0; object < 2; ++object) {
    double gcrs[3] = {states.position_m[object], states.position_m[3 + object],
                      states.position_m[6 + object]};
    double itrs[3];
    eraRxp(itrs_from_gcrs, gcrs, itrs);
    for (int i = 0; i < 3; ++i) EXPECT_NEAR(km[3 * object + i] * 1e3, itrs[i], 4.0);
  }
  for (int i = 6; i < 9; ++i) EXPECT_EQ(km[i], 0.0f);  // without a state
}

TEST_F(LiveViewTest, EveryKindOfStateMakesValidMessages) {
  for (unsigned seed = 0; seed < 20; ++seed) {
    for (const auto& example : test::examples(seed)) view.take(example.state);
    view.publish();
  }
  for (const auto slot : {MessageSlot::roster, MessageSlot::sensors, MessageSlot::detections,
                          MessageSlot::tracks, MessageSlot::tasks})
    EXPECT_TRUE(told(slot).is_object()) << int(slot);
  ASSERT_TRUE(latest.of(MessageSlot::objects));
  EXPECT_TRUE(latest.of(MessageSlot::objects)->binary);
  EXPECT_TRUE(view.has_roster());
  EXPECT_GE(history.span().snapshots, 1u);
}

TEST_F(LiveViewTest, NoTruthReachesViewers) {
  view.take(State(truth_of(1)));
  view.publish();
  for (const auto& slot : latest.all()) EXPECT_FALSE(slot.message);
}

TEST_F(LiveViewTest, TruthThatIsAskedForIsThatOfTheLastFrame) {
  LiveView referee(latest, history, true);
  referee.take(State(truth_of(4)));
  referee.take(State(truth_of(3)));  // late
  referee.publish();
  const Json truths = told(MessageSlot::truth)["truths"];
  ASSERT_EQ(truths.size(), 1u);
  EXPECT_EQ(truths[0]["name"], "SECRET");
  EXPECT_EQ(truths[0]["sensor"], "alpha");
  EXPECT_EQ(truths[0]["frame"], 4);
  EXPECT_EQ(truths[0]["path_px"], Json({3.5, 0.0, 0.0, 0.0, 0.0, 7.25}));
  // Who looks back sees none.
  const auto past = history.at(1e9);
  ASSERT_TRUE(past);
  for (const auto& message : past->messages)
    EXPECT_EQ(message->bytes.find("SECRET"), std::string::npos);
}

TEST_F(LiveViewTest, StatusHasNodesWithStateLagAndGaps) {
  RunStatus status{.run_id = 0xab, .phase = Phase::running, .granted = 9, .last_tick = 20};
  status.tick_length = sim_seconds(5);
  status.start_utc = "2018-01-21T00:15:00Z";
  status.settled = 4;
  status.holding = {"b"};
  status.nodes = {
      {.name = "a", .done = 9}, {.name = "b", .done = 4}, {.name = "c", .alive = false}};
  view.take(status, {{"b", 3}});
  const Json json = told(MessageSlot::status);
  EXPECT_EQ(json["time_s"], 20.0);
  EXPECT_EQ(json["nodes"][0]["state"], "alive");
  EXPECT_EQ(json["nodes"][1]["state"], "awaited");
  EXPECT_EQ(json["nodes"][1]["lag_ticks"], 5);
  EXPECT_EQ(json["nodes"][1]["gaps"], 3);
  EXPECT_EQ(json["nodes"][2]["state"], "lost");
  // Reference: date -u -d 2018-01-21T00:15:00Z +%s
  EXPECT_EQ(told(MessageSlot::run)["start_utc_ms"], 1516493700000.0);
}

TEST_F(LiveViewTest, KeepsTheNewestFrameAndItsDetections) {
  turn_the_earth();
  FrameReport report{.sensor = "alpha", .frame = 3};
  report.wcs.crpix_x = 255.5, report.wcs.crpix_y = 191.5;
  report.wcs.cd_deg = {-0.01, 0, 0, 0.01};
  report.sensor_position_m = {6378e3, 0, 0};
  view.take(State(report));
  view.take(State(DetectionSet{"alpha", 3, std::vector<Detection>(2)}));
  view.publish();
  report.frame = 2;  // late
  view.take(State(report));
  view.take(State(DetectionSet{"alpha", 2, std::vector<Detection>(7)}));
  view.publish();
  const Json sensor = told(MessageSlot::sensors)["sensors"][0];
  EXPECT_EQ(sensor["frame"], 3);
  EXPECT_EQ(sensor["columns"], 512);
  EXPECT_EQ(sensor["rows"], 384);
  EXPECT_EQ(sensor["field"].size(), 3u * 24);
  EXPECT_EQ(told(MessageSlot::detections)["detections"].size(), 2u);
}

// Frames of each run count from 1, and its time begins at 0.
TEST_F(LiveViewTest, AnotherRunIsSeenFromItsBeginning) {
  FrameReport report{.sensor = "alpha", .frame = 9, .end = sim_seconds(90)};
  report.wcs.crpix_x = 255.5, report.wcs.crpix_y = 191.5;
  report.wcs.cd_deg = {-0.01, 0, 0, 0.01};
  const auto see = [&] {
    turn_the_earth();
    view.take(State(report));
    view.publish();
  };
  view.take(RunStatus{.run_id = 1}, {});
  view.take(State(ObjectRoster{}));
  see();
  EXPECT_EQ(history.span().to_s, 90.0);
  view.take(RunStatus{.run_id = 2}, {});
  view.publish();
  EXPECT_TRUE(told(MessageSlot::sensors)["sensors"].empty());
  EXPECT_FALSE(view.has_roster());
  report.frame = 1;
  report.end = sim_seconds(10);
  see();
  EXPECT_EQ(told(MessageSlot::sensors)["sensors"][0]["frame"], 1);
  EXPECT_EQ(history.span().to_s, 10.0);
}

// Prints what a second of a large run costs: ten states of 20,000 objects as they come over the
// wire, a frame with ten detections of each of 100 sensors, two answers of the time-master. Asserts
// no time.
TEST_F(LiveViewTest, CostOfASecondOfTwentyThousandObjectsAndAHundredSensors) {
  constexpr std::size_t objects = 20'000;
  constexpr int sensors = 100;
  const RunFacts run{.run_id = 1, .tick_length = sim_seconds(1), .last_tick = 1000};
  Receiver receiver(run);
  const auto allow = [&](const std::string& topic) { receiver.allow(topic, "source", 1); };
  ObjectStates states{.tick = 1, .time = sim_seconds(1), .count = objects};
  for (auto* numbers : {&states.position_m, &states.slope_m_per_s, &states.velocity_m_per_s})
    numbers->assign(3 * objects, 7e3);
  states.position_m.assign(3 * objects, 4.2e6);
  states.code.assign(objects, 0);
  const auto sealed = [&](const std::string& topic, const State& state, Tick tick) {
    allow(topic);
    Encoded encoded = encode(state);
    return seal(topic,
                {.run_id = 1,
                 .publisher = "source",
                 .sequence = 1,
                 .kind = encoded.kind,
                 .tick = tick,
                 .time = run.time_of(tick)},
                encoded.payload, encoded.arrays);
  };
  const Frames frames = sealed(objects_topic, State(states), 1);
  std::vector<Frames> reports;
  RunStatus status{.run_id = 1, .phase = Phase::running, .last_tick = 1000};
  status.tick_length = run.tick_length;
  for (const auto& example : test::examples(1)) {
    const auto* report = std::get_if<FrameReport>(&example.state);
    const auto* set = std::get_if<DetectionSet>(&example.state);
    for (int i = 0; (report || set) && i < sensors; ++i) {
      const std::string name = "sensor-" + std::to_string(i);
      if (report) {
        FrameReport own = *report;
        own.sensor = name;
        reports.push_back(sealed(frame_prefix + name, State(own), example.tick));
        status.nodes.push_back({.name = name});
      } else if (!set->detections.empty()) {
        DetectionSet own{name, set->frame, std::vector<Detection>(10, set->detections[0])};
        for (std::uint32_t k = 0; k < 10; ++k) {
          own.detections[k].sensor = name, own.detections[k].index = k;
          own.detections[k].frame = own.frame;
          own.detections[k].id = name + "/" + std::to_string(own.frame) + "/" + std::to_string(k);
        }
        reports.push_back(sealed(detection_prefix + name, State(own), example.tick));
      }
    }
  }
  ASSERT_EQ(reports.size(), 2u * sensors);

  turn_the_earth();
  const auto take = [&](const Frames& message) {
    const std::string_view parts[]{message.topic, message.envelope, message.payload,
                                   message.arrays};
    const auto received = receiver.receive({parts, message.arrays.empty() ? 3u : 4u});
    ASSERT_TRUE(received) << receiver.last_refusal();
    view.take(*received->state);
  };
  constexpr int seconds = 5;
  const auto began = std::clock();
  for (int tenth = 0; tenth < 10 * seconds; ++tenth) {
    take(frames);
    for (std::size_t i = tenth % 10; i < reports.size(); i += 10) take(reports[i]);
    if (tenth % 5 == 0) view.take(status, {});
    view.publish();
  }
  const double share = double(std::clock() - began) / CLOCKS_PER_SEC / seconds;
  std::printf("processor seconds for a second of the run: %.4f\n", share);
  EXPECT_EQ(told(MessageSlot::sensors)["sensors"].size(), std::size_t(sensors));
}

}  // namespace
}  // namespace dmise
