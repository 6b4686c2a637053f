// Paths of satellites over a site, by element sets that clients give.
#include "sensors/observatory/satellite_path.h"

#include <gtest/gtest.h>

#include "core/config/make_clock.h"
#include "sensors/observatory/device_error.h"
#include "tests/observatory/small_scenario.h"

namespace dmise {
namespace {

// Elements by Vallado et al., AIAA 2006-6753, with the epoch of the scenario.
const std::string line1 = "1 25544U 98067A   18021.02083333  .00000000  00000-0  00000-0 0  9990";
const std::string line2 = "2 25544  51.6400 200.0000 0003000 100.0000  60.0000 15.54000000    06";

std::string with_checksum(std::string line) {
  int sum = 0;
  for (std::size_t i = 0; i < 68; ++i)
    sum += line[i] == '-'                                      ? 1
           : std::isdigit(static_cast<unsigned char>(line[i])) ? line[i] - '0'
                                                               : 0;
  line[68] = char('0' + sum % 10);
  return line;
}

TEST(SatellitePath, ReadsOneElementSet) {
  const std::string lines = with_checksum(line1) + "\n" + with_checksum(line2) + "\n";
  EXPECT_EQ(elements_in(lines).catalogue_number, 25544u);
  EXPECT_EQ(elements_in("ISS (ZARYA)\n" + lines).name, "ISS (ZARYA)");
  for (const std::string& text :
       {std::string(), std::string("ISS"), lines + lines.substr(0, 30), std::string(3000, '1')})
    EXPECT_THROW(elements_in(text), DeviceError) << text;
}

// A satellite 400 km up moves by 7.7 km/s: over the zenith by 1.1 deg/s, never faster.
TEST(SatellitePath, MovesAsASatelliteDoes) {
  const Scenario scenario = small_observatory(testing::TempDir() + "/path.yaml");
  const SatellitePath path(scenario, scenario.sensors[0], make_clock(scenario),
                           elements_in(with_checksum(line1) + "\n" + with_checksum(line2)));
  double fastest = 0.0;
  for (int t_s = 0; t_s < 6000; t_s += 30) {
    const Vec<Enu> before = path.seen(sim_seconds(t_s)), after = path.seen(sim_seconds(t_s + 1));
    EXPECT_NEAR(norm(before), 1.0, 1e-12);
    fastest = std::max(fastest, angle_rad(before, after) / deg);
  }
  EXPECT_GT(fastest, 0.05);
  EXPECT_LT(fastest, 1.25);
}

}  // namespace
}  // namespace dmise
