#include "core/base/parallel.h"

#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <numeric>
#include <stdexcept>
#include <thread>
#include <vector>

#include "core/base/cancellation.h"
#include "core/base/detached_work.h"

namespace dmise {
namespace {

TEST(Threads, EveryItemIsWorkedOnceInTheSameRanges) {
  for (const int count : {1, 2, 4}) {
    Threads threads(count);
    for (const std::size_t items : {0u, 1u, 7u, 1000u}) {
      std::vector<std::atomic<int>> seen(items);
      threads.for_ranges(items, 64, [&](std::size_t begin, std::size_t end) {
        EXPECT_EQ(begin % 64, 0u);
        EXPECT_LE(end - begin, 64u);
        for (std::size_t i = begin; i < end; ++i) ++seen[i];
      });
      for (const auto& times : seen) EXPECT_EQ(times, 1);
    }
  }
}

TEST(Threads, AnExceptionComesBackAndThePoolGoesOn) {
  Threads threads(3);
  EXPECT_THROW(threads.for_ranges(100, 1,
                                  [](std::size_t begin, std::size_t) {
                                    if (begin == 50) throw std::runtime_error("x");
                                  }),
               std::runtime_error);
  std::atomic<int> sum{0};
  threads.for_ranges(100, 1, [&](std::size_t, std::size_t) { ++sum; });
  EXPECT_EQ(sum, 100);
}

TEST(Threads, CancelledLoopsOfAThreadEndAndOthersGoOn) {
  std::atomic<bool> asked = false;
  Threads threads(3);
  std::atomic<int> worked{0};
  {
    CancellationScope scope(asked);
    EXPECT_THROW(threads.for_ranges(1000, 1,
                                    [&](std::size_t, std::size_t) {
                                      ++worked;
                                      asked = true;
                                    }),
                 Cancelled);
    EXPECT_LE(worked, 3);
    std::thread([&] {
      int sum = 0;
      Threads(1).for_ranges(10, 1, [&](std::size_t, std::size_t) { ++sum; });
      EXPECT_EQ(sum, 10);
    }).join();
  }
  threads.for_ranges(10, 1, [&](std::size_t, std::size_t) { ++worked; });
  EXPECT_GE(worked, 11);
}

// A billion ranges that throw one after the other would take an hour.
TEST(Threads, ACancelledLoopSkipsItsOtherRanges) {
  const std::atomic<bool> asked = true;
  CancellationScope scope(asked);
  int caught = 0;
  const auto begin = std::chrono::steady_clock::now();
  for (int i = 0; i < 100; ++i) try {
      Threads(1).for_ranges(1'000'000'000, 1, [](std::size_t, std::size_t) {});
    } catch (const Cancelled&) {
      ++caught;
    }
  EXPECT_EQ(caught, 100);
  EXPECT_LT(std::chrono::steady_clock::now() - begin, std::chrono::seconds(10));
}

// A fork has none of the threads.
TEST(DetachedWork, IsNotWaitedForInAFork) {
  std::atomic<bool> go = false;
  start_detached([&] {
    while (!go) std::this_thread::yield();
  });
  const pid_t child = ::fork();
  if (child == 0) ::_exit(wait_for_detached(std::chrono::milliseconds(0)) ? 0 : 1);
  int status = -1;
  ::waitpid(child, &status, 0);
  EXPECT_EQ(status, 0);
  go = true;
  EXPECT_TRUE(wait_for_detached(std::chrono::seconds(100)));
}

TEST(DetachedWork, IsWaitedFor) {
  std::atomic<bool> go = false, done = false;
  start_detached([&] {
    while (!go) std::this_thread::yield();
    done = true;
  });
  EXPECT_FALSE(wait_for_detached(std::chrono::milliseconds(1)));
  go = true;
  EXPECT_TRUE(wait_for_detached(std::chrono::seconds(100)));
  EXPECT_TRUE(done);
}

}  // namespace
}  // namespace dmise
