#include "core/config/objects/object_names.h"

#include <gtest/gtest.h>

namespace dmise {
namespace {

TEST(ObjectNames, EachOfTwoNamesIsSuggestedInAnyCase) {
  const std::vector<std::string> names{"GOES 13", "OSCAR 7 (AO-7)", "ISS (ZARYA)", "METOP-B"};
  EXPECT_EQ(nearest_object("OSCAR 77", names), "OSCAR 7 (AO-7)");
  EXPECT_EQ(nearest_object("OSKAR 7", names), "OSCAR 7 (AO-7)");
  EXPECT_EQ(nearest_object("ao-8", names), "OSCAR 7 (AO-7)");
  EXPECT_EQ(nearest_object("zarja", names), "ISS (ZARYA)");
  EXPECT_EQ(nearest_object("goes13", names), "GOES 13");
  EXPECT_EQ(nearest_object("hubble", names), "");
  EXPECT_EQ(nearest_object("x", {}), "");
}

}  // namespace
}  // namespace dmise
