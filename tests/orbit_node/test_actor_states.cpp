#include "core/propagation/actor_states.h"

#include <gmock/gmock.h>

#include "core/propagation/object_states.h"
#include "orbit-node/orbit_actor.h"
#include "tests/orbit_node/scenario_directory.h"

namespace dmise {
namespace {

using test::ScenarioDirectory;

class ActorStatesTest : public ScenarioDirectory {
 protected:
  static constexpr double r = 7.0e6;

  /// `probe` is moved and turned, `fixed` is turned alone, `nadir` is moved alone.
  Scenario scenario() {
    return load(
        "  - {name: probe, motion: {node: gnc}, attitude: {node: gnc}}\n"
        "  - {name: fixed, motion: {fixed: {gcrs_m: [0, 4e7, 0]}}, attitude: {node: gnc}}\n"
        "  - {name: nadir, motion: {node: gnc}, attitude: nadir}\n"
        "nodes: [{name: gnc, run: [sh]}]\n");
  }

  static Message told(Tick tick, SimTime time, std::size_t count = 3) {
    ObjectStates states{.tick = tick, .time = time, .count = count};
    states.position_m.assign(3 * count, 0.0);
    states.slope_m_per_s.assign(3 * count, 0.0);
    for (std::size_t i = 0; i < count; ++i) {
      states.position_m[i] = r + double(i);
      states.slope_m_per_s[2 * count + i] = 7500.0;
    }
    states.velocity_m_per_s = states.slope_m_per_s;
    states.velocity_m_per_s[0] = 0.25;
    states.code.assign(count, 0);
    states.attitude_object = {0, 1};
    states.gcrs_from_body = {0.6, 1, 0.8, 0, 0, 0, 0, 0};
    states.attitude_rate_rad_per_s = {0.1, 0, 0, 0, 0, 0.2};
    return {std::string(actor_prefix) + "gnc", tick, std::make_shared<State>(std::move(states))};
  }
};

TEST_F(ActorStatesTest, WhatANodeSaysIsTheStateOfItsObjects) {
  const Scenario read = scenario();
  const Clock clock = make_clock(read);
  Threads threads(1);
  const auto population = load_objects(read, clock);
  const StateSource source(population, clock, threads);
  const SimTime time = read.time_of(2);
  ActorStates actors;
  ASSERT_TRUE(actors.add(told(2, time)));
  const ObjectStates states = source.at(2, time, &actors);
  EXPECT_THAT(states.code, testing::ElementsAre(0, 0, 0));
  EXPECT_EQ(states.position(0), (Vec<Gcrs>{r, 0, 0}));
  EXPECT_EQ(states.slope(0), (Vec<Gcrs>{0, 0, 7500}));
  EXPECT_EQ(states.velocity_m_per_s[0], 0.25);  // the model's own, which may differ from the slope
  EXPECT_EQ(states.position(1), (Vec<Gcrs>{0, 4e7, 0}));
  EXPECT_EQ(states.position(2), (Vec<Gcrs>{r + 2, 0, 0}));
  EXPECT_EQ(states.attitude(0)->gcrs_from_body, (Quaternion{0.6, 0.8, 0, 0}));
  EXPECT_EQ(states.attitude(1)->rate_rad_per_s, (Vec<Gcrs>{0, 0, 0.2}));
  // A path along z at x = r has a nadir that turns by v / r about -y.
  EXPECT_NEAR(states.attitude(2)->rate_rad_per_s.y, -7500.0 / (r + 2), 1e-9);
  for (std::uint32_t i = 0; i < 3; ++i) {
    const ObjectStates one = source.of_some({{i}}, 2, source.instants(time), &actors);
    EXPECT_EQ(one.position(0), states.position(i));
    EXPECT_EQ(one.attitude(0)->gcrs_from_body, states.attitude(i)->gcrs_from_body);
  }
}

TEST_F(ActorStatesTest, WithoutItsNodeAnObjectIsNotInTheScene) {
  const Scenario read = scenario();
  const Clock clock = make_clock(read);
  Threads threads(1);
  const auto population = load_objects(read, clock);
  const StateSource source(population, clock, threads);
  ActorStates actors;
  actors.add(told(2, read.time_of(2)));
  const auto untold = std::uint8_t(MotionCode::untold);
  for (const ObjectStates& states : {source.at(1, read.time_of(1), &actors), source.at(2, {})}) {
    EXPECT_THAT(states.code, testing::ElementsAre(untold, untold, untold));
    EXPECT_THAT(states.position_m, testing::Each(0.0));
    EXPECT_THAT(states.gcrs_from_body, testing::Each(0.0));
    EXPECT_THAT(source.why_absent(0, states), testing::HasSubstr("its node gives it no state"));
  }
  actors.add(told(3, read.time_of(3), 2));
  EXPECT_THROW(source.at(3, read.time_of(3), &actors), Error);
  actors.forget_before(3);
  EXPECT_FALSE(actors.of("gnc", 2, 0));
}

TEST_F(ActorStatesTest, TheOrbitNodePublishesWhatItHears) {
  const Scenario read = scenario();
  Threads threads(1);
  OrbitActor actor(read, make_clock(read), threads);
  EXPECT_THAT(actor.consumes(), testing::ElementsAre("state/actor/gnc"));
  const std::vector<Message> heard{told(1, read.time_of(1))};
  const auto messages = actor.step(1, heard);
  EXPECT_EQ(std::get<ObjectStates>(*messages.back().state).position(0), (Vec<Gcrs>{r, 0, 0}));
  Scenario alone = read;
  alone.network.publish_states = false;
  EXPECT_TRUE(OrbitActor(alone, make_clock(alone), threads).consumes().empty());
}

}  // namespace
}  // namespace dmise
