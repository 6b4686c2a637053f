#include <gtest/gtest.h>

#include <memory>
#include <stdexcept>

#include "core/base/error.h"
#include "core/propagation/environment_source.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"
#include "nodes/own/own_function.h"

namespace dmise {
namespace {

/// Starts a model that `answer` speaks for, after it has said that it is ready.
std::unique_ptr<OwnModel> started(
    const std::function<v1::OwnNodeAnswer(const v1::OwnNodeRequest&)>& answer) {
  static const Scenario scenario;
  static const OwnNode node{.name = "finder"};
  const OwnNodeSettings settings;
  v1::OwnNodeBegin begin;
  begin.set_sensor("eye");
  const auto start = functions_in_process([answer](const FunctionRequest& asked) {
    EXPECT_EQ(asked.node, "finder");
    EXPECT_EQ(asked.sensor, "eye");
    v1::OwnNodeRequest request;
    EXPECT_TRUE(request.ParseFromArray(asked.frames[0].data(), int(asked.frames[0].size())));
    return std::vector<std::string>{answer(request).SerializeAsString()};
  });
  return start({scenario, node, settings, begin});
}

v1::OwnNodeAnswer ready() {
  v1::OwnNodeAnswer answer;
  answer.mutable_ready();
  return answer;
}

TEST(OwnFunction, AnswersAreThoseOfItsFunctionWhichHearsTheRequests) {
  const auto model = started([](const v1::OwnNodeRequest& request) {
    if (request.has_begin()) {
      EXPECT_EQ(request.begin().node(), "finder");
      EXPECT_EQ(request.begin().schema_version(), 1);
      return ready();
    }
    v1::OwnNodeAnswer answer;
    answer.mutable_found()->add_sources()->set_snr(request.frame().frame());
    return answer;
  });
  v1::OwnNodeFrame frame;
  for (const std::uint32_t number : {1, 2}) {
    frame.set_frame(number);
    EXPECT_EQ(model->find(frame, "counts")->sources(0).snr(), number);
  }
}

TEST(OwnFunction, TakesOneRequestAtATime) {
  const auto model = started([](const v1::OwnNodeRequest&) { return ready(); });
  const Clock clock(parse_utc("2018-01-21T00:15:00Z"));
  EXPECT_FALSE(model->ask_ahead({}, environment_at(clock, 0, {0})));
}

TEST(OwnFunction, WhatIsNoAnswerIsAnError) {
  v1::OwnNodeAnswer answer;
  const auto begin_fails = [&] { started([&](const v1::OwnNodeRequest&) { return answer; }); };
  EXPECT_THROW(begin_fails(), Error);
  answer.mutable_found();
  EXPECT_THROW(begin_fails(), Error);
  answer.set_failed("no fuel");
  EXPECT_THROW(begin_fails(), Error);
  const auto model = started([](const v1::OwnNodeRequest&) { return ready(); });
  EXPECT_THROW(model->find({}, ""), Error);
}

TEST(OwnFunction, WhatItsFunctionThrowsComesOut) {
  const auto model = started([](const v1::OwnNodeRequest& request) {
    if (!request.has_begin()) throw std::domain_error("the model's");
    return ready();
  });
  EXPECT_THROW(model->find({}, ""), std::domain_error);
}

}  // namespace
}  // namespace dmise
