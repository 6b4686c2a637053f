#include "core/dataset/npy.h"

#include <gtest/gtest.h>

#include <vector>

namespace dmise {
namespace {

// Layout: NEP 1, "A Simple File Format for NumPy Arrays"; numpy reads it in read_dataset.py.
TEST(Npy, HeaderAndDataAreThoseOfVersion1) {
  const std::vector<std::uint16_t> pixels{1, 2, 3, 256, 5, 65535};
  const std::string bytes = npy_bytes(pixels, 3, 2);
  EXPECT_EQ(bytes.substr(0, 8), std::string("\x93NUMPY\x01\x00", 8));
  const std::size_t header = std::size_t(std::uint8_t(bytes[8])) + 256 * std::uint8_t(bytes[9]);
  EXPECT_EQ((10 + header) % 64, 0u);
  EXPECT_NE(bytes.find("'shape': (2, 3)"), std::string::npos);
  EXPECT_EQ(bytes[10 + header - 1], '\n');
  EXPECT_EQ(bytes.substr(10 + header), std::string("\1\0\2\0\3\0\0\1\5\0\xff\xff", 12));
}

}  // namespace
}  // namespace dmise
