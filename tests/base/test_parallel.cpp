#include "core/base/parallel.h"

#include <gtest/gtest.h>

#include <atomic>
#include <numeric>
#include <stdexcept>
#include <vector>

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

}  // namespace
}  // namespace dmise
