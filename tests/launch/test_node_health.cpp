// What `dmise health` makes of the time-master's answer.
#include "launch/process/node_health.h"

#include <gtest/gtest.h>

namespace dmise {
namespace {

TEST(NodeHealth, IsThatOfTheNodeAsTheTimeMasterHearsIt) {
  RunStatus status;
  status.phase = Phase::running;
  status.nodes = {{.name = "alpha", .done = 6, .times = {}},
                  {.name = "beta", .done = 4, .alive = false, .times = {}}};
  status.missing = {"gamma"};
  EXPECT_EQ(health_problem(status, "alpha"), "");
  EXPECT_EQ(health_problem(status, "beta"), "the time-master has lost beta (last tick done: 4)");
  EXPECT_EQ(health_problem(status, "gamma"), "gamma has not joined");
  EXPECT_EQ(health_problem(status, "delta"), "delta is not a node of this run");
  EXPECT_EQ(health_problem(status, "time-master"), "");
  status.phase = Phase::ended;
  EXPECT_EQ(health_problem(status, "beta"), "");  // has left after the last tick
  status.phase = Phase::failed;
  status.cause = "beta has been silent";
  for (const char* name : {"alpha", "time-master"})
    EXPECT_EQ(health_problem(status, name), "the run has failed: beta has been silent");
}

}  // namespace
}  // namespace dmise
