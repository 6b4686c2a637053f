#include "core/base/formatted.h"

#include <gtest/gtest.h>

#include <cstdlib>

namespace dmise {
namespace {

TEST(Formatted, IsWhatPrintfWouldPrint) {
  EXPECT_EQ(formatted("%s: %06.2f of %zu", "frame", 3.14159, std::size_t(7)), "frame: 003.14 of 7");
  EXPECT_EQ(formatted("%s", ""), "");
}

TEST(Formatted, HasAnyLength) {
  for (const std::size_t length : {254u, 255u, 256u, 257u, 5000u}) {
    const std::string word(length, 'x');
    EXPECT_EQ(formatted("<%s>", word.c_str()), "<" + word + ">");
  }
}

TEST(Counted, HasOneThingOrSeveral) {
  EXPECT_EQ(counted(1, "sensor"), "1 sensor");
  EXPECT_EQ(counted(0, "sensor"), "0 sensors");
  EXPECT_EQ(counted(2, "pass", "passes"), "2 passes");
}

TEST(ShortestText, ReadsBackToTheSameBits) {
  for (const double value : {0.1, 1.0 / 3.0, 6.02e23, -5e-324, 1.7976931348623157e308})
    EXPECT_EQ(std::strtod(shortest_text(value).c_str(), nullptr), value);
  EXPECT_EQ(shortest_text(0.1), "0.1");
}

}  // namespace
}  // namespace dmise
