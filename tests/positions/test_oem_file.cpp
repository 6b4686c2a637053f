#include "core/orbit/oem_file.h"

#include <gtest/gtest.h>

#include <filesystem>

#include "core/base/error.h"
#include "core/base/files/text_file.h"
#include "core/base/files/whole_file.h"
#include "core/orbit/oem.h"

namespace dmise {
namespace {

/// A state every second on a circle of 7000 km, at 00:00:SS.
struct Circle {
  std::string utc(int s) const {
    char text[64];
    std::snprintf(text, sizeof text, "2018-01-21T00:00:%02d.000000000Z", s);
    return text;
  }
  void add(OemFile& file, int s) const {
    const double w = 1.08e-3, a = w * s, r = 7e6;
    file.add(utc(s), s > 0 ? utc(s - 1) : "", {r * std::cos(a), r * std::sin(a), 0},
             {-r * w * std::sin(a), r * w * std::cos(a), 0});
  }
};

class OemFileTest : public testing::Test {
 public:
  ~OemFileTest() override { std::filesystem::remove(path_); }

 protected:
  OemFileTest() { std::filesystem::remove(path_); }
  std::string path_ =
      testing::TempDir() + "/oem-" + testing::UnitTest::GetInstance()->current_test_info()->name();
  OemSubject subject_{"ISS (ZARYA)", "98067A", "2018-01-21T00:00:00.000000000Z"};
  Circle circle_;
};

TEST_F(OemFileTest, IsReadBackToAMicrometreAfterEveryState) {
  OemFile file(path_, subject_);
  file.begin();
  for (int s = 0; s <= 20; ++s) {
    circle_.add(file, s);
    const Trajectory read = read_oem(path_);
    ASSERT_EQ(read.segments.size(), 1u);
    EXPECT_EQ(read.segments[0].object_name, "ISS (ZARYA)");
    EXPECT_EQ(read.segments[0].time_s.size(), std::size_t(s + 1));
    EXPECT_NEAR(read.segments[0].usable_stop_s, s, 1e-9);
    EXPECT_NEAR(read.segments[0].position_m[std::size_t(s)].y, 7e6 * std::sin(1.08e-3 * s), 1e-6);
    // STOP_TIME is checked by readers other than ours.
    EXPECT_NE(read_text_file(path_).find("STOP_TIME = " + circle_.utc(s)), std::string::npos);
  }
}

TEST_F(OemFileTest, AGapBeginsASegmentAndALoneStateIsOneToo) {
  OemFile file(path_, subject_);
  file.begin();
  for (const int s : {0, 1, 2, 5, 8, 9, 10, 13}) circle_.add(file, s);
  const Trajectory read = read_oem(path_);
  ASSERT_EQ(read.segments.size(), 4u);
  EXPECT_EQ(read.segments[0].time_s.size(), 3u);
  ASSERT_EQ(read.segments[1].time_s.size(), 1u);
  EXPECT_NEAR(read.segments[1].time_s[0], 5.0, 1e-9);
  EXPECT_EQ(read.segments[1].usable_stop_s, read.segments[1].usable_start_s);
  EXPECT_EQ(read.segments[2].time_s.size(), 3u);
  EXPECT_EQ(read.segments[3].time_s.size(), 1u);
}

TEST_F(OemFileTest, WithoutAStateThereIsNoFile) {
  write_file_whole(path_, "CCSDS_OEM_VERS = 2.0\nMETA_START\n");
  OemFile file(path_, subject_);
  file.keep_before(circle_.utc(0));
  EXPECT_FALSE(std::filesystem::exists(path_));
  file.begin();
  EXPECT_FALSE(std::filesystem::exists(path_));
  circle_.add(file, 0);
  EXPECT_EQ(read_oem(path_).segments.size(), 1u);
}

// CCSDS 502.0-B-2, 7.2.3: printable ASCII.
TEST_F(OemFileTest, NamesAreInPrintableAscii) {
  OemFile file(path_, {"na\xc3\xafve", "98\t067A", subject_.creation_date});
  file.begin();
  circle_.add(file, 0);
  const std::string text = read_text_file(path_);
  EXPECT_NE(text.find("\nOBJECT_NAME = na??ve\nOBJECT_ID = 98?067A\n"), std::string::npos) << text;
}

TEST_F(OemFileTest, TakenUpAtAnyStateItBecomesTheSameBytes) {
  const std::vector<int> all{0, 3, 4, 5, 8, 10, 11};
  {
    OemFile file(path_, subject_);
    file.begin();
    for (const int s : all) circle_.add(file, s);
  }
  const std::string whole = read_text_file(path_);
  for (int from = 0; from <= 11; ++from) {
    write_file_whole(path_, whole + "2018-01-21T00:00:12.0000");  // and a line cut short
    OemFile file(path_, subject_);
    file.keep_before(circle_.utc(from));
    for (const int s : all)
      if (s >= from) circle_.add(file, s);
    EXPECT_EQ(read_text_file(path_), whole) << from;
  }
}

TEST_F(OemFileTest, ADirectoryThatIsNotThereIsNamed) {
  const std::string path = testing::TempDir() + "not-there/x.oem";
  OemFile file(path, subject_);
  file.begin();
  try {
    circle_.add(file, 0);
    FAIL();
  } catch (const Error& e) {
    EXPECT_EQ(e.what(), path + ": can't be written: No such file or directory");
  }
}

}  // namespace
}  // namespace dmise
