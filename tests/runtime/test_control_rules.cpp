// Which words of the control connections have a meaning.
#include "nodes/runtime/protocol/control_rules.h"

#include <gtest/gtest.h>

#include <cmath>

namespace dmise {
namespace {

TEST(ControlRules, ANameIsALineOfText) {
  v1::NodeMessage message;
  EXPECT_TRUE(fault_of(message));  // has no body
  message.mutable_join()->set_name("alpha");
  message.mutable_join()->add_produces("detection/alpha");
  EXPECT_FALSE(fault_of(message));
  for (const std::string& name : {std::string(), std::string("a\nb"), std::string(257, 'a')}) {
    message.mutable_join()->set_name(name);
    EXPECT_TRUE(fault_of(message)) << name;
  }
}

TEST(ControlRules, NumbersAreThoseOfARun) {
  v1::NodeMessage message;
  message.mutable_done()->set_tick(0);
  EXPECT_FALSE(fault_of(message));
  for (const std::int64_t tick : {std::int64_t(-1), INT64_MIN, INT64_MAX}) {
    message.mutable_done()->set_tick(tick);
    EXPECT_TRUE(fault_of(message)) << tick;
  }
  message.mutable_heartbeat()->set_name("alpha");
  for (const double wrong : {-1.0, double(NAN), double(INFINITY)}) {
    EXPECT_FALSE(fault_of(message));
    message.mutable_heartbeat()->mutable_times()->set_compute_s(wrong);
    EXPECT_TRUE(fault_of(message)) << wrong;
    message.mutable_heartbeat()->clear_times();
  }
  v1::ResendRequest request;
  request.set_topic("detection/alpha");
  EXPECT_FALSE(fault_of(request));
  request.set_from_tick(-1);
  EXPECT_TRUE(fault_of(request));
}

TEST(ControlRules, ACommandIsOneThatThereIs) {
  v1::NodeMessage message;
  for (int action = -1; action <= 77; ++action) {
    message.mutable_control()->set_action(v1::Control::Action(action));
    EXPECT_EQ(fault_of(message).has_value(), action < 1 || action > 6) << action;
  }
}

TEST(ControlRules, APaceIsAFactor) {
  v1::NodeMessage message;
  message.mutable_control()->set_action(v1::Control::ACTION_PACE);
  for (const double factor : {0.0, 0.1, 1e6}) {
    message.mutable_control()->set_factor(factor);
    EXPECT_FALSE(fault_of(message)) << factor;
  }
  for (const double factor : {-1.0, 1.1e6, double(NAN), double(INFINITY)}) {
    message.mutable_control()->set_factor(factor);
    EXPECT_TRUE(fault_of(message)) << factor;
  }
}

TEST(ControlRules, ARunFitsIntoIntegerNanoseconds) {
  v1::MasterMessage message;
  auto* welcome = message.mutable_welcome();
  welcome->set_tick_ns(5'000'000'000);
  welcome->set_last_tick(24);
  welcome->set_window_ticks(4);
  welcome->set_heartbeat_s(0.25);
  welcome->set_silent_after_s(5);
  EXPECT_FALSE(fault_of(message));
  const v1::MasterMessage good = message;
  welcome->set_last_tick(std::int64_t(1) << 40);
  EXPECT_TRUE(fault_of(message));
  message = good;
  message.mutable_welcome()->set_tick_ns(0);
  EXPECT_TRUE(fault_of(message));
  message = good;
  message.mutable_welcome()->set_heartbeat_s(NAN);
  EXPECT_TRUE(fault_of(message));
  message = good;
  message.mutable_welcome()->set_window_ticks(0);
  EXPECT_TRUE(fault_of(message));
}

}  // namespace
}  // namespace dmise
