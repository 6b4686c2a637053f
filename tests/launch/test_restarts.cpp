#include "launch/process/restarts.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <thread>

namespace dmise {
namespace {

using namespace std::chrono_literals;

// A node whose first process was killed, and whose second ends by itself with a code.
class RestartsTest : public testing::Test {
 protected:
  void begin(const std::string& second_ends_with) {
    processes.start("host-1",
                    {"/bin/sh", "-c",
                     "if [ -e " + mark + " ]; then exit " + second_ends_with + "; fi; touch " +
                         mark + "; kill -9 $$"},
                    mark + ".log");
    wait_for_its_end();
    status.phase = Phase::connecting;
    status.nodes = {{.name = "host-1"}};  // the master has not missed it
    ASSERT_EQ(restarts.check(status, at).size(), 1u);
    wait_for_its_end();
  }
  void wait_for_its_end() {
    const auto deadline = std::chrono::steady_clock::now() + 30s;
    while (processes.poll() && std::chrono::steady_clock::now() < deadline)
      std::this_thread::yield();
    ASSERT_FALSE(processes.poll());
  }
  void TearDown() override {
    std::filesystem::remove(mark);
    std::filesystem::remove(mark + ".log");
  }

  const std::string mark = testing::TempDir() + "/restarts";
  NetworkConfig network{.on_silent_node = OnSilentNode::restart, .join_within_s = 60.0};
  Supervisor processes;
  Restarts restarts{processes, network};
  RunStatus status;
  Restarts::Instant at = std::chrono::steady_clock::now();
};

TEST_F(RestartsTest, WhoWasRefusedBeginsAgainAsSoonAsItsPredecessorIsMissed) {
  begin("1");
  EXPECT_TRUE(restarts.check(status, at + 500ms).empty());
  EXPECT_TRUE(restarts.check(status, at + 4s).empty());  // the predecessor counts as alive
  status.nodes[0].alive = false;
  EXPECT_EQ(restarts.check(status, at + 5s).size(), 1u);
}

TEST_F(RestartsTest, AnAgentThatIsMissedBeforeTheStartBeginsAgain) {
  begin("1");
  status.nodes = {{.name = "broker"}};  // agents are not waited for by their names
  status.missing = {"alpha"};
  EXPECT_EQ(restarts.check(status, at + 5s).size(), 1u);
}

TEST_F(RestartsTest, WhoCanNotUseTheScenarioIsNotStartedAgainAtOnce) {
  begin("2");
  status.nodes[0].alive = false;
  EXPECT_TRUE(restarts.check(status, at + 5s).empty());
}

}  // namespace
}  // namespace dmise
