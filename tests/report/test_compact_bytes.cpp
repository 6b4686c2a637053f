#include <gtest/gtest.h>

#include <array>

#include "core/report/compact_bytes.h"
#include "tests/report/inflated.h"

namespace dmise {
namespace {

// Reference: RFC 4648, section 10.
TEST(CompactBytes, WritesTheBase64OfItsStandard) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("foob"), "Zm9vYg==");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
}

TEST(CompactBytes, InflatesToTheSame) {
  std::string bytes;
  for (int k = 0; k < 100'000; ++k) bytes += char(k * k >> 3);
  EXPECT_EQ(inflated(compact(bytes), bytes.size()), bytes);
  EXPECT_LT(compact(std::string(100'000, 'x')).size(), 400u);
}

TEST(CompactBytes, PutsBytesOfOneRankTogether) {
  const std::array<std::int32_t, 2> numbers{0x04030201, -1};
  EXPECT_EQ(byte_planes(numbers), "\x01\xff\x02\xff\x03\xff\x04\xff");
  const std::array<std::uint16_t, 2> words{0x0201, 0x0403};
  EXPECT_EQ(byte_planes(words), "\x01\x03\x02\x04");
}

}  // namespace
}  // namespace dmise
