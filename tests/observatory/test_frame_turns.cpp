// Which frame is made next when there are more than processors.
#include "sensors/observatory/frame_turns.h"

#include <gtest/gtest.h>

#include <chrono>
#include <thread>
#include <vector>

#include "core/base/cancellation.h"

namespace dmise {
namespace {

void wait_for(FrameTurns& turns, std::size_t waiting) {
  const auto patience = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  while (turns.waiting() != waiting) {
    ASSERT_LT(std::chrono::steady_clock::now(), patience);
    std::this_thread::yield();
  }
}

TEST(FrameTurns, GoToWhatIsDueFirst) {
  FrameTurns turns(1);
  const std::atomic<bool> wanted = false;
  std::mutex mutex;
  std::vector<int> order;
  std::vector<std::thread> threads;
  {
    const auto turn = turns.take(sim_seconds(9), wanted);
    for (const int due : {3, 1, 2})
      threads.emplace_back([&, due] {
        const auto mine = turns.take(sim_seconds(due), wanted);
        const std::lock_guard lock(mutex);
        order.push_back(due);
      });
    wait_for(turns, 3);
  }
  for (std::thread& thread : threads) thread.join();
  EXPECT_EQ(order, (std::vector<int>{1, 2, 3}));
}

TEST(FrameTurns, EndForWhatIsNotWanted) {
  FrameTurns turns(1);
  const std::atomic<bool> wanted = false;
  std::atomic<bool> unwanted = false;
  bool cancelled = false;
  const auto turn = turns.take(sim_seconds(1), wanted);
  std::thread waits([&] {
    try {
      turns.take(sim_seconds(2), unwanted);
    } catch (const Cancelled&) {
      cancelled = true;
    }
  });
  wait_for(turns, 1);
  unwanted = true;
  turns.wake();
  waits.join();
  EXPECT_TRUE(cancelled);
  EXPECT_EQ(turns.waiting(), 0u);
}

}  // namespace
}  // namespace dmise
