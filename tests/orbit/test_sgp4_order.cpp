#include <gtest/gtest.h>

#include <thread>

#include "tests/orbit/sgp4_orbits.h"
#include "tests/support/simd.h"

namespace dmise {
namespace {

using namespace test;

class Sgp4Order : public testing::TestWithParam<SimdLevel> {};
INSTANTIATE_TEST_SUITE_P(Simd, Sgp4Order, testing::ValuesIn(simd_here()), simd_name);

TEST_P(Sgp4Order, ResonantStatesDoNotDependOnTheOrderOfTimes) {
  const std::vector<MeanElements> elements = mixture(120);
  std::vector<double> days;
  for (int k = 0; k < 40; ++k) days.push_back(double(k * 7919 % 97) - 48.5 + 0.25 * (k % 5));
  const Sgp4Batch used(elements, nullptr, GetParam());
  for (double d : days) {
    const Outputs from_epoch = at(Sgp4Batch(elements, nullptr, GetParam()), epoch_jd1, d);
    EXPECT_TRUE(from_epoch == at(used, epoch_jd1, d)) << d;
  }
}

TEST_P(Sgp4Order, ThreadsShareABatchAndAgreeToTheBit) {
  const Sgp4Batch batch(mixture(3000), nullptr, GetParam());
  std::vector<Outputs> expected;
  for (int k = 0; k < 8; ++k) expected.push_back(at(batch, epoch_jd1, 5.0 * k - 17.0));
  std::vector<int> equal(4, 0);
  std::vector<std::thread> threads;
  for (int id = 0; id < 4; ++id)
    threads.emplace_back([&, id] {
      for (int k = 0; k < 16; ++k) {
        const int j = (k * 5 + id * 3) % 8;
        equal[std::size_t(id)] += at(batch, epoch_jd1, 5.0 * j - 17.0) == expected[std::size_t(j)];
      }
    });
  for (std::thread& t : threads) t.join();
  EXPECT_EQ(equal, std::vector<int>(4, 16));
  Threads two(2), three(3);
  EXPECT_TRUE(at(batch, epoch_jd1, -17.0, &two) == expected[0]);
  EXPECT_TRUE(at(batch, epoch_jd1, -17.0, &three) == expected[0]);
}

TEST_P(Sgp4Order, OneSomeManyTimesAndAllAreTheSameToTheBit) {
  const Sgp4Batch batch(mixture(500), nullptr, GetParam());
  const std::size_t n = batch.size();
  const double jd1 = epoch_jd1 + 3.0, jd2 = 0.6180339887498949;
  const Outputs all = at(batch, jd1, jd2);
  std::vector<std::uint32_t> objects;
  for (std::uint32_t k = 0; k < 300; ++k) objects.push_back(k * 211 % 500);
  Outputs some(objects.size());
  batch.propagate_some(objects, jd1, jd2, some.position, some.velocity, some.code);
  for (std::size_t k = 0; k < objects.size(); ++k) {
    const std::size_t i = objects[k];
    const Sgp4State one = batch.propagate_one(i, batch.minutes_since_epoch(i, jd1, jd2));
    EXPECT_EQ(some.code[k], all.code[i]);
    EXPECT_EQ(std::uint8_t(one.code), all.code[i]);
    EXPECT_EQ(some.position[k + objects.size()], all.position[i + n]);
    EXPECT_EQ(one.position_m.y, all.position[i + n]);
    EXPECT_EQ(one.velocity_m_per_s.z, all.velocity[i + 2 * n]);
  }
}

TEST_P(Sgp4Order, ManyTimesInOneCallEqualCallsOfTheirOwnToTheBit) {
  const Sgp4Batch batch(mixture(3000), nullptr, GetParam());
  const std::size_t n = batch.size();
  std::vector<Utc> times;
  for (int k = 0; k < 19; ++k) times.push_back({epoch_jd1 + 7.0 * (k * 5 % 19) - 60.0, 0.05 * k});
  Threads three(3);
  for (Threads* threads : {static_cast<Threads*>(nullptr), &three}) {
    Outputs together(n * times.size());
    batch.propagate(times, together.position, together.velocity, together.code, threads);
    for (std::size_t k = 0; k < times.size(); ++k) {
      const Outputs alone = at(batch, times[k].jd1, times[k].jd2);
      EXPECT_TRUE(std::equal(alone.position.begin(), alone.position.end(),
                             together.position.begin() + std::ptrdiff_t(3 * n * k)));
      EXPECT_TRUE(std::equal(alone.velocity.begin(), alone.velocity.end(),
                             together.velocity.begin() + std::ptrdiff_t(3 * n * k)));
      EXPECT_TRUE(std::equal(alone.code.begin(), alone.code.end(),
                             together.code.begin() + std::ptrdiff_t(n * k)));
    }
  }
}

TEST_P(Sgp4Order, AnyNumberOfObjectsIsWrittenWholeAndNothingBeside) {
  for (std::size_t n = 1; n < 70; ++n) {
    const Sgp4Batch batch(mixture(n), nullptr, GetParam());
    constexpr double untouched = -1.0;
    std::vector<double> position(3 * n + 2, untouched), velocity(3 * n + 2, untouched);
    std::vector<std::uint8_t> code(n + 2, 99);
    batch.propagate(epoch_jd1, 0.25, {&position[1], 3 * n}, {&velocity[1], 3 * n}, {&code[1], n});
    EXPECT_EQ(position.front(), untouched);
    EXPECT_EQ(position.back(), untouched);
    EXPECT_EQ(velocity.front(), untouched);
    EXPECT_EQ(velocity.back(), untouched);
    EXPECT_EQ(code.front(), 99);
    EXPECT_EQ(code.back(), 99);
    for (std::size_t i = 0; i < n; ++i) {
      const Sgp4State one = batch.propagate_one(i, batch.minutes_since_epoch(i, epoch_jd1, 0.25));
      EXPECT_EQ(std::uint8_t(one.code), code[1 + i]);
      EXPECT_EQ(one.position_m.x, position[1 + i]);
      EXPECT_EQ(one.position_m.z, position[1 + i + 2 * n]);
      EXPECT_EQ(one.velocity_m_per_s.y, velocity[1 + i + n]);
    }
  }
}

TEST_P(Sgp4Order, ACatalogueTakenPieceByPieceIsTheSameToTheBit) {
  const std::vector<MeanElements> elements = mixture(1000);
  const Sgp4Batch whole(elements, nullptr, GetParam());
  Sgp4Batch pieces(GetParam());
  const std::span<const MeanElements> all = elements;
  for (std::size_t first = 0, count = 1; first < all.size();
       first += count, count = 2 * count + 1) {
    pieces.append(all.subspan(first, std::min(count, all.size() - first)));
    at(pieces, epoch_jd1, 12.0);  // leaves memos of resonance behind
  }
  for (double days : {0.25, 12.0, -40.0})
    EXPECT_TRUE(at(whole, epoch_jd1, days) == at(pieces, epoch_jd1, days)) << days;
}

}  // namespace
}  // namespace dmise
