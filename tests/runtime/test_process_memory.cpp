#include "nodes/runtime/process/process_memory.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstddef>
#include <vector>

namespace dmise {
namespace {

TEST(ProcessMemory, GrowsByWhatIsWritten) {
  constexpr std::size_t bytes = 64 << 20;
  const ProcessMemory before = process_memory();
  const std::vector<char> block(bytes, 'x');
  const ProcessMemory with = process_memory();
  EXPECT_EQ(block.back(), 'x');
  EXPECT_GT(with.private_bytes, before.private_bytes + bytes / 2);
  EXPECT_GE(with.peak_resident_bytes, with.private_bytes);
  EXPECT_GE(with.peak_resident_bytes, before.peak_resident_bytes);
}

TEST(ProcessMemory, AgeIsThatOfTheProcess) {
  static const auto loaded = std::chrono::steady_clock::now();
  const double before_s = process_age_s();
  while (std::chrono::steady_clock::now() - loaded < std::chrono::milliseconds(50)) {
  }
  EXPECT_GE(before_s, 0.0);
  EXPECT_GT(process_age_s(), before_s);
  EXPECT_LT(process_age_s(), 3600.0);
}

}  // namespace
}  // namespace dmise
