#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/wait.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <functional>
#include <zmq.hpp>

#include "clients/cpp/node.h"
#include "core/base/error.h"
#include "core/base/files/text_file.h"
#include "core/orbit/motion.h"
#include "core/propagation/environment_source.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"
#include "nodes/own/own_program.h"
#include "nodes/runtime/process/spawn.h"
#include "nodes/runtime/transport/socket.h"
#include "nodes/wire/own_node.h"
#include "nodes/wire/state_codec.h"

namespace dmise {
namespace {

using testing::HasSubstr;

constexpr std::chrono::seconds patience{10};

v1::OwnNodeBegin begin(const std::string& options = "{}") {
  v1::OwnNodeBegin begin;
  begin.set_schema_version(wire_schema_version);
  begin.set_options_json(options);
  begin.set_start_utc("2018-01-21T00:15:00Z");
  begin.set_tick_ns(1'000'000'000);
  begin.set_last_tick(10);
  begin.set_period_ticks(1);
  begin.set_seed(5);
  begin.set_alive_every_s(0.1);
  for (const char* name : {"a", "b", "c"}) begin.add_objects()->set_name(name);
  begin.mutable_objects(0)->set_turned(true);
  begin.mutable_objects(1)->set_turned(true);
  return begin;
}

EnvironmentState environment_of(Tick tick) {
  static const Clock clock(parse_utc("2018-01-21T00:15:00Z"));
  return environment_at(clock, tick, {tick * 1'000'000'000});
}

v1::OwnNodeStep step_of(Tick tick, bool give_checkpoint = false) {
  v1::OwnNodeStep step;
  step.set_tick(tick);
  step.set_time_ns(tick * 1'000'000'000);
  step.set_give_checkpoint(give_checkpoint);
  return step;
}

OwnProgram::Stepped asked(OwnProgram& program, Tick tick, bool give_checkpoint = false) {
  program.ask(step_of(tick, give_checkpoint), environment_of(tick));
  return *program.stepped();
}

std::string error_of(const std::function<void()>& does) {
  try {
    does();
  } catch (const Error& error) {
    return error.what();
  }
  return "no error";
}

std::string request_of(const v1::OwnNodeBegin& begin) {
  v1::OwnNodeRequest request;
  *request.mutable_begin() = begin;
  return request.SerializeAsString();
}
std::string request_of(const v1::OwnNodeStep& step) {
  v1::OwnNodeRequest request;
  *request.mutable_step() = step;
  return request.SerializeAsString();
}

using Request = std::vector<std::string>;  // frames

class CppNode : public testing::Test {
 public:
  ~CppNode() override { std::filesystem::remove_all(directory_); }

 protected:
  CppNode() { std::filesystem::create_directories(directory_); }

  OwnProgram program(const v1::OwnNodeBegin& begun = begin()) const {
    return {{.name = "gnc", .command = {DMISE_WALK_NODE}, .log_path = log_}, begun, true};
  }
  /// Why the program can't go on after these requests, by its last answer and its last line.
  std::string refusal_of(const std::vector<Request>& requests) const;
  std::string why_begin_fails(const v1::OwnNodeBegin& wrong) const {
    return refusal_of({{request_of(wrong)}});
  }
  std::string why_step_fails(const std::string& fault) const;

  const std::string directory_ =
      (std::filesystem::path(testing::TempDir()) / "dmise-cpp-node").string();
  const std::string log_ = directory_ + "/log";
};

std::string CppNode::refusal_of(const std::vector<Request>& requests) const {
  PrivateEndpoint endpoint;
  zmq::context_t context;
  zmq::socket_t socket = make_socket(context, zmq::socket_type::pair, max_data_bytes);
  bind_to(socket, endpoint.address());
  const pid_t pid =
      spawn({.name = "walk",
             .arguments = {DMISE_WALK_NODE},
             .log_path = log_,
             .environment = {std::string(own_node_variable) + "=" + endpoint.address()}});
  for (const Request& request : requests)
    for (std::size_t i = 0; i < request.size(); ++i)
      socket.send(zmq::buffer(request[i]),
                  i + 1 < request.size() ? zmq::send_flags::sndmore : zmq::send_flags::none);
  int status = 0;
  EXPECT_EQ(waitpid(pid, &status, 0), pid);
  EXPECT_EQ(WEXITSTATUS(status), 1);
  v1::OwnNodeAnswer answer;
  std::vector<zmq::pollitem_t> items{{socket.handle(), 0, ZMQ_POLLIN, 0}};
  while (!answer.has_failed()) {
    wait_for(items, patience);
    const auto frames = receive(socket);
    if (frames.empty()) break;
    EXPECT_TRUE(from_frame(frames[0], &answer));
  }
  EXPECT_EQ(read_text_file(log_), "walk-node: " + answer.failed() + "\n");
  return answer.failed();
}

std::string CppNode::why_step_fails(const std::string& fault) const {
  OwnProgram program = this->program(begin(R"({"fault": ")" + fault + "\"}"));
  for (Tick tick = 0; tick < 3; ++tick) asked(program, tick);
  return error_of([&] { asked(program, 3); });
}

TEST_F(CppNode, SaysTheStatesOfItsModel) {
  OwnProgram program = this->program();
  for (Tick tick = 0; tick < 3; ++tick) {
    const ObjectStates states = asked(program, tick).states;
    EXPECT_EQ(states.tick, tick);
    EXPECT_EQ(states.time.ns, tick * 1'000'000'000);
    EXPECT_EQ(states.code, (std::vector<std::uint8_t>{0, std::uint8_t(MotionCode::untold), 0}));
    const double place_m = 5.0 * double(tick + 1) + (tick > 0) + (tick > 1) * std::sqrt(2.0);
    EXPECT_EQ(states.position(0), (Vec<Gcrs>{place_m, 7e6, 0}));
    EXPECT_EQ(states.position(1), Vec<Gcrs>{});
    EXPECT_EQ(states.slope(2), (Vec<Gcrs>{1, 2, 3}));
    EXPECT_EQ(states.velocity_m_per_s, states.slope_m_per_s);
    EXPECT_EQ(states.attitude_object, (std::vector<std::uint32_t>{0, 1}));
    EXPECT_EQ(states.attitude(0)->gcrs_from_body, (Quaternion{0, 1, 0, 0}));
    EXPECT_EQ(states.attitude(0)->rate_rad_per_s, (Vec<Gcrs>{0, 0, 0.5}));
    EXPECT_FALSE(states.attitude(1));
  }
}

TEST_F(CppNode, ContinuesFromItsCheckpoint) {
  OwnProgram first = program();
  EXPECT_FALSE(asked(first, 0).checkpoint);
  const auto stepped = asked(first, 1, true);
  v1::OwnNodeBegin again = begin();
  again.set_checkpoint(*stepped.checkpoint);
  OwnProgram second = program(again);
  EXPECT_EQ(asked(first, 2).states.position(2).z, asked(second, 2).states.position(2).z);
}

TEST_F(CppNode, HearsWhatOthersPublish) {
  OwnProgram program = this->program();
  v1::OwnNodeStep step = step_of(0);
  for (const std::uint32_t frame : {3u, 4u}) {
    const Encoded encoded = encode(State(DetectionSet{.sensor = "alpha", .frame = frame}));
    v1::OwnNodeHeard& one = *step.add_heard();
    one.set_topic("detection/alpha");
    one.set_kind(v1::KIND_DETECTION_SET);
    one.set_payload(encoded.payload);
  }
  program.ask(step, environment_of(0));
  EXPECT_EQ(program.stepped()->states.position(0).x, 5.0 + 300.0 + 400.0);
  step.mutable_heard(1)->set_payload("\xff");
  step.set_tick(1);
  program.ask(step, environment_of(1));
  EXPECT_THROW(program.stepped(), Error);
}

TEST_F(CppNode, WhatItsModelThrowsIsTheReason) {
  EXPECT_EQ(why_step_fails("throws"), "no fuel");
  EXPECT_EQ(why_step_fails("throws_a_number"), "its model throws what is no std::exception");
  EXPECT_THAT(why_step_fails("nan"), HasSubstr("position_m: "));
  EXPECT_EQ(why_step_fails("too_many"), "its model says 5 states, of 3 objects");
  EXPECT_EQ(why_step_fails("no_attitude"), "attitude: is needed of a, which the node turns");
}

TEST_F(CppNode, RefusesWhatIsNoBegin) {
  v1::OwnNodeBegin wrong = begin();
  wrong.set_schema_version(2);
  EXPECT_EQ(why_begin_fails(wrong), "the run has schema version 2, this program 1");
  wrong = begin();
  wrong.set_sensor("alpha");
  EXPECT_THAT(why_begin_fails(wrong), HasSubstr("detect in the frames of alpha"));
  wrong = begin();
  wrong.mutable_tracking();
  EXPECT_THAT(why_begin_fails(wrong), HasSubstr("make the tracks"));
  wrong = begin();
  wrong.mutable_observing()->mutable_sensor()->set_name("radar");
  EXPECT_THAT(why_begin_fails(wrong), HasSubstr("observe as radar"));
  for (const char* text : {"", "[1]", "{", "{\"a\": nan}"})
    EXPECT_EQ(why_begin_fails(begin(text)), "begin: options_json: must be one JSON object");
  for (const double every_s : {0.0, -1.0, std::nan(""), 1e300}) {
    wrong = begin();
    wrong.set_alive_every_s(every_s);
    EXPECT_EQ(why_begin_fails(wrong), "begin: alive_every_s: must be in (0, 1e6]");
  }
  wrong = begin();
  wrong.set_tick_ns(0);
  EXPECT_EQ(why_begin_fails(wrong), "begin: tick_ns: must be > 0");
  EXPECT_EQ(refusal_of({{request_of(begin())}, {request_of(begin())}}), "the run begins twice");
}

TEST_F(CppNode, RefusesWhatIsNoStep) {
  const std::string begun = request_of(begin()), step = request_of(step_of(0));
  const std::string environment = encode(environment_of(0)).payload;
  EXPECT_EQ(refusal_of({{std::string(1000, '\xff')}}),
            "what the run says is no request (1000 bytes)");
  EXPECT_EQ(refusal_of({{""}}), "what the run says is no request (0 bytes)");
  EXPECT_EQ(refusal_of({{step, environment}}), "the run asks for a step before it begins");
  EXPECT_EQ(refusal_of({{begun}, {step}}), "a step: must have 2 frames, got 1");
  EXPECT_EQ(refusal_of({{begun}, {step, environment, ""}}), "a step: must have 2 frames, got 3");
  EXPECT_EQ(refusal_of({{begun}, {step, "\xff"}}), "not a EnvironmentState");
  EXPECT_THAT(refusal_of({{begun}, {step, ""}}), HasSubstr("must have 9 values, got 0"));
  EXPECT_EQ(refusal_of({{begun}, {request_of(step_of(1)), environment}}),
            "a step: must have the environment of its tick, got that of tick 0");
  v1::OwnNodeRequest frame;
  frame.mutable_frame();
  EXPECT_EQ(refusal_of({{begun}, {frame.SerializeAsString(), ""}}),
            "the run asks for what is no state of objects");
}

TEST(ActorTask, SaysWhichOptionIsWrong) {
  const ActorTask task{
      .options = {{"r_m", 7e6}, {"name", "a"}, {"xyz", {1, 2.5, -3}}, {"two", {1, 2}}}};
  EXPECT_EQ(task.number("r_m"), 7e6);
  EXPECT_EQ(task.vector("xyz"), (Vec<Gcrs>{1, 2.5, -3}));
  const auto number = [&](const char* option) { return error_of([&] { task.number(option); }); };
  const auto vector = [&](const char* option) { return error_of([&] { task.vector(option); }); };
  EXPECT_EQ(number("v"), "option v: is missing");
  EXPECT_EQ(number("name"), "option name: must be a number, got \"a\"");
  EXPECT_EQ(vector("v"), "option v: is missing");
  EXPECT_EQ(vector("r_m"), "option r_m: must be a list of 3 numbers, got 7000000.0");
  EXPECT_EQ(vector("two"), "option two: must be a list of 3 numbers, got [1,2]");
}

TEST_F(CppNode, SaysWhoStartsIt) {
  const pid_t pid = spawn({.name = "walk", .arguments = {DMISE_WALK_NODE}, .log_path = log_});
  int status = 0;
  EXPECT_EQ(waitpid(pid, &status, 0), pid);
  EXPECT_EQ(WEXITSTATUS(status), 1);
  EXPECT_THAT(read_text_file(log_), HasSubstr("walk-node: DMISE_OWN_NODE is not set"));
}

}  // namespace
}  // namespace dmise
