#include "bench/validation/observed_light.h"

#include <gmock/gmock.h>

#include <filesystem>

#include "bench/validation/brightness.h"
#include "core/base/error.h"
#include "core/base/files/paths.h"
#include "core/base/files/whole_file.h"

namespace dmise {
namespace {

using testing::HasSubstr;

struct Exposures : testing::Test {
  Exposures() {
    setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
    make_directories(directory_ + "/brightness", "test");
  }
  ~Exposures() override { std::filesystem::remove_all(directory_); }

  ObservedSet read(const std::string& rows) {
    write(rows);
    return read_exposures(path_);
  }
  void write(const std::string& rows) {
    write_file_whole(path_,
                     "# Mount Lemmon\nobservation_time,satellite_height,satellite_altitude,"
                     "satellite_azimuth,ab_magnitude\n" +
                         rows);
  }
  static std::string complaint(const auto& reads) {
    try {
      reads();
    } catch (const ConfigError& e) {
      return e.what();
    }
    return "";
  }

  std::string directory_ = testing::TempDir() + "observed_light";
  std::string path_ = directory_ + "/brightness/pomenis_even.csv";
};

// A file in the order of nights alone is put in the order of time, and a night is one track.
TEST_F(Exposures, AreInOrderOfTime) {
  const ObservedSet set = read(
      "2022-10-18T12:26:00,550,60,90,5.5\n2022-10-18T02:33:28,550,60,270,5.0\n"
      "2022-10-19T02:39:14,550,60,270,6.0\n2022-10-18T02:30:14,550,60,270,4.5\n");
  ASSERT_EQ(set.lights.size(), 4u);
  EXPECT_EQ(set.tracks, 2u);
  const double mag[] = {4.5, 5.0, 5.5, 6.0};
  for (std::size_t i = 0; i < 4; ++i) {
    EXPECT_EQ(set.lights[i].measured_mag, mag[i]) << i;
    EXPECT_EQ(set.lights[i].track, i / 3) << i;
  }
}

TEST_F(Exposures, SayWhereAndWhatIsWrong) {
  const std::string good = "2022-10-18T12:26:00,550,60,90,5.5\n";
  for (const auto& [row, reason] :
       {std::pair{"2022-10-18T12:26:00,-7000,60,90,5.5",
                  ":4: satellite_height: must be a number in [100, 100000], got"},
        {"2022-10-18T12:26:00,550,nan,90,5.5",
         ":4: satellite_altitude: must be a number in [0, 90], got"},
        {"2022-10-18T12:26:00,550,60,90,99",
         ":4: ab_magnitude: must be a number in [-10, 25], got"},
        {"2022-10-18T12:26:00,550,60,90", ":4: not as many fields as the header"},
        {"yesterday,550,60,90,5.5", ":4: observation_time: not a UTC time"}})
    EXPECT_THAT(complaint([&, row = row] { read(good + row + "\n"); }), HasSubstr(reason));
}

// A median of nothing, 0, would reach each target.
TEST_F(Exposures, TooFewJudgeNothing) {
  write("2022-10-18T12:26:00,550,60,90,5.5\n2022-10-19T02:39:14,550,60,270,6.0\n");
  EXPECT_THAT(complaint([&] { compare_brightness(directory_, 1); }),
              HasSubstr("too few measurements in sunlight: 1 to fit and 1 to judge by"));
  write("2022-10-18T07:00:00,550,60,90,5.5\n");  // in the Earth's shadow
  EXPECT_THAT(complaint([&] { compare_brightness(directory_, 1); }),
              HasSubstr("no measurement is in sunlight"));
}

}  // namespace
}  // namespace dmise
