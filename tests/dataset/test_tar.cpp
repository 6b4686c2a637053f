#include "core/dataset/tar.h"

#include <gtest/gtest.h>

#include "core/base/error.h"

namespace dmise {
namespace {

// Layout: POSIX.1-2017, pax, "ustar Interchange Format"; Python's tarfile reads it in
// read_dataset.py.
TEST(Tar, MemberIsWholeBlocksWithAChecksum) {
  const std::string member = tar_member("a/b.txt", std::string(513, 'x'));
  ASSERT_EQ(member.size(), 3 * 512u);
  EXPECT_EQ(member.substr(0, 8), std::string("a/b.txt\0", 8));
  EXPECT_EQ(member.substr(124, 12), std::string("00000001001\0", 12));
  EXPECT_EQ(member.substr(257, 8), std::string("ustar\0"
                                               "00",
                                               8));
  unsigned sum = 0;
  for (std::size_t i = 0; i < 512; ++i)
    sum += i >= 148 && i < 156 ? ' ' : static_cast<unsigned char>(member[i]);
  EXPECT_EQ(std::stoul(member.substr(148, 6), nullptr, 8), sum);
  EXPECT_EQ(member.substr(154, 2), std::string("\0 ", 2));
}

TEST(Tar, ContentOfWholeBlocksHasNoPadding) {
  EXPECT_EQ(tar_member("a", std::string(1024, 'x')).size(), 3 * 512u);
  EXPECT_EQ(tar_member("a", "").size(), 512u);
  EXPECT_EQ(tar_end(), std::string(1024, '\0'));
}

TEST(Tar, LongNamesAreRefused) { EXPECT_THROW(tar_member(std::string(101, 'n'), ""), Error); }

}  // namespace
}  // namespace dmise
