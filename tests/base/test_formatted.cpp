#include "core/base/formatted.h"

#include <gtest/gtest.h>

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

}  // namespace
}  // namespace dmise
