#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "tests/orbit/sgp4_orbits.h"

namespace {
std::atomic<long> blocks_taken{0};
}

[[gnu::noinline]] void* operator new(std::size_t bytes) {
  ++blocks_taken;
  if (void* block = std::malloc(bytes ? bytes : 1)) return block;
  throw std::bad_alloc();
}
[[gnu::noinline]] void operator delete(void* block) noexcept { std::free(block); }
[[gnu::noinline]] void operator delete(void* block, std::size_t) noexcept { std::free(block); }

namespace dmise {
namespace {

using namespace test;

TEST(Sgp4Batch, TakesNoMemoryInATick) {
  const Sgp4Batch batch(mixture(3000));
  Outputs out(batch.size()), many(4 * batch.size());
  const std::vector<Utc> times{
      {epoch_jd1, 0.0}, {epoch_jd1, 0.1}, {epoch_jd1, 0.2}, {epoch_jd1, 5}};
  const std::vector<std::uint32_t> some{7, 77, 777};
  std::vector<double> r(9), v(9);
  std::vector<std::uint8_t> code(3);
  const long before = blocks_taken;
  for (int k = 0; k < 20; ++k) {
    batch.propagate(epoch_jd1, 0.37 * k, out.position, out.velocity, out.code);
    batch.propagate(times, many.position, many.velocity, many.code);
    batch.propagate_some(some, epoch_jd1, 0.37 * k, r, v, code);
  }
  EXPECT_EQ(blocks_taken, before);
}

}  // namespace
}  // namespace dmise
