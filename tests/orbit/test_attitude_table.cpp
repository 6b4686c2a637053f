#include "core/orbit/attitude_table.h"

#include <gmock/gmock.h>

#include "core/base/error.h"

namespace dmise {
namespace {

TEST(AttitudeTable, IsReadByItsHeaderAndNormalised) {
  const auto table = parse_attitude_table(
      "# of a test\r\ntime_s,w,x,y,z\r\n-1.5, 1.0001,0,0,0\r\n\r\n2e1,0,0.6,0,-0.8\r\n", "t");
  ASSERT_EQ(table.time_s.size(), 2u);
  EXPECT_EQ(table.time_s[1], 20.0);
  EXPECT_EQ(table.gcrs_from_body[0].w, 1.0);
  EXPECT_DOUBLE_EQ(table.gcrs_from_body[1].z, -0.8);
}

TEST(AttitudeTable, FaultsPointAtTheirLine) {
  const auto complaint = [](const std::string& rows) -> std::string {
    try {
      parse_attitude_table("time_s,w,x,y,z\n" + rows, "t.csv");
      return "";
    } catch (const ConfigError& e) {
      return e.what();
    }
  };
  EXPECT_EQ(complaint("0,1,0,0\n"), "t.csv:2: expected a time and 4 numbers, got \"0,1,0,0\"");
  EXPECT_EQ(complaint("0,1,0,0,nan\n"), "t.csv:2: not a number, got \"nan\"");
  EXPECT_EQ(complaint("1,1,0,0,0\n1,1,0,0,0\n"), "t.csv:3: times must increase, got \"1\"");
  EXPECT_THAT(complaint("0,0,0,0,0\n"), testing::HasSubstr("t.csv:2: a quaternion of length 0"));
  EXPECT_THAT(complaint("0,1,0,0,0\n"), testing::HasSubstr("a table needs at least two lines"));
  EXPECT_THROW(parse_attitude_table("1,2,3\n", "t.csv"), ConfigError);
  EXPECT_THROW(parse_attitude_table("", "t.csv"), ConfigError);
}

}  // namespace
}  // namespace dmise
