#include "core/base/numeric/rare.h"

#include <gtest/gtest.h>

#include <string>

namespace dmise {
namespace {

TEST(Rare, IsACopyOfItsValue) {
  const Rare<std::string> none, one = std::string("panel");
  EXPECT_FALSE(none);
  ASSERT_TRUE(one);
  Rare<std::string> other = one;
  EXPECT_EQ(other, one);
  EXPECT_NE(&*other, &*one);
  other = none;
  EXPECT_FALSE(other);
  EXPECT_EQ(other, none);
  EXPECT_FALSE(other == one);
  other = std::string("panels");
  EXPECT_FALSE(other == one);
  EXPECT_EQ(other->size(), 6u);
  EXPECT_EQ(sizeof other, sizeof(void*));
}

TEST(Rare, TakesWhatMayBeMissing) {
  EXPECT_FALSE(Rare<int>(std::optional<int>()));
  EXPECT_EQ(*Rare<int>(std::optional<int>(3)), 3);
}

}  // namespace
}  // namespace dmise
