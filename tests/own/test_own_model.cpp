#include "nodes/own/own_model.h"

#include <gmock/gmock.h>

#include <utility>

#include "nodes/wire/state_codec.h"

namespace dmise {
namespace {

using testing::HasSubstr;

/// Answers by frames that are given, the first of which is this head.
class Said : public OwnModel {
 public:
  explicit Said(const v1::OwnNodeAnswer& head, std::vector<std::string> more = {})
      : Said(head.SerializeAsString(), std::move(more)) {}
  explicit Said(std::string head, std::vector<std::string> more = {}) : frames_(std::move(more)) {
    frames_.insert(frames_.begin(), std::move(head));
  }

  v1::OwnNodeRequest asked;           // last
  std::vector<std::string> asked_by;  // the frames after it
  bool stopped = false, silent = false;

 private:
  bool send(const v1::OwnNodeRequest& request, Frames more) override {
    asked = request;
    asked_by.assign(more.begin(), more.end());
    return !stopped;
  }
  bool send_ahead(const v1::OwnNodeRequest& request, Frames more) override {
    return send(request, more);
  }
  std::optional<Answer> answer() override {
    if (silent) return std::nullopt;
    return answer_in({frames_.begin(), frames_.end()}, nullptr);
  }

  std::vector<std::string> frames_;
};

/// What a call throws; empty if nothing.
template <class Call>
std::string error_of(Call&& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

v1::OwnNodeAnswer found(double snr) {
  v1::OwnNodeAnswer answer;
  answer.mutable_found()->add_sources()->set_snr(snr);
  return answer;
}

TEST(OwnModel, FindsWhatItIsAsked) {
  Said model(found(7.5));
  v1::OwnNodeFrame frame;
  frame.set_frame(3);
  EXPECT_EQ(model.find(frame, "counts").value().sources(0).snr(), 7.5);
  EXPECT_EQ(model.asked.frame().frame(), 3u);
  EXPECT_THAT(model.asked_by, testing::ElementsAre("counts"));
}

TEST(OwnModel, StepsHaveStatesTheirDigestAndACheckpoint) {
  ObjectStates states;
  states.tick = 4;
  const Encoded body = encode(State(states));
  v1::OwnNodeAnswer head;
  head.mutable_stepped()->set_checkpoint("kept");
  const auto stepped = Said(head, {body.payload, body.arrays}).stepped().value();
  EXPECT_EQ(stepped.states.tick, 4);
  EXPECT_EQ(stepped.checkpoint, "kept");
  states.tick = 5;
  const Encoded other = encode(State(states));
  const auto next = Said(head, {other.payload, other.arrays}).stepped().value();
  EXPECT_NE(next.digest, stepped.digest);
}

TEST(OwnModel, WhatIsNoAnswerIsAnErrorOfOneLine) {
  const auto find = [](Said model) { return error_of([&] { model.find({}, ""); }); };
  EXPECT_EQ(find(Said(found(1))), "");
  EXPECT_THAT(find(Said(std::string())), HasSubstr("is no answer (0 bytes)"));
  EXPECT_THAT(find(Said(std::string("\xff\xff\xff"))), HasSubstr("is no answer (3 bytes)"));
  EXPECT_THAT(find(Said(found(1), {"more"})), HasSubstr("in 2 frames instead of 1"));
  v1::OwnNodeAnswer ready;
  ready.mutable_ready();
  EXPECT_THAT(find(Said(ready)), HasSubstr("answers a frame by something else"));
  v1::OwnNodeAnswer failed;
  failed.set_failed("no\nfuel");
  EXPECT_EQ(find(Said(failed)).find('\n'), std::string::npos);
  EXPECT_THAT(find(Said(failed)), HasSubstr("fuel"));
}

TEST(OwnModel, StatesThatAreNoneAreRefused) {
  v1::OwnNodeAnswer head;
  head.mutable_stepped();
  EXPECT_NE(error_of([&] { Said(head, {"\xff", ""}).stepped(); }), "");
  EXPECT_NE(error_of([&] { Said(head, {"", "seven b"}).stepped(); }), "");
}

TEST(OwnModel, SaysNothingAfterTheStop) {
  Said model(found(1));
  model.silent = true;
  EXPECT_FALSE(model.find({}, ""));
  EXPECT_FALSE(model.stepped());
  model.stopped = true;
  EXPECT_FALSE(model.observe({}, {}));
  EXPECT_FALSE(model.track({}, {}));
  EXPECT_FALSE(model.ask({}, {}));
}

}  // namespace
}  // namespace dmise
