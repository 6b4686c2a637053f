#include "bench/validation/sky_brightness.h"

#include <gmock/gmock.h>

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

struct PublishedSky : testing::Test {
  static const SkyTable& table(const std::string& name) {
    static const std::vector<SkyTable> tables = compare_sky();
    return *std::ranges::find(tables, name, &SkyTable::name);
  }
  static SkyFigures figures(const std::string& name) { return figures_of(table(name)); }
};

// Sites and nights differ by 0.2 to 0.5 mag; in U the sky of La Palma was brighter at the Sun's
// minimum than that of Paranal at its maximum.
TEST_F(PublishedSky, IsDarkAtThreeObservatories) {
  EXPECT_EQ(figures("dark").cells, 15u);
  EXPECT_LT(std::abs(figures("dark").median_mag), 0.2);
  EXPECT_LT(figures("dark").worst_mag, 0.7);
}

TEST_F(PublishedSky, IsMoonlitAsEsosCalculatorHasIt) {
  EXPECT_LT(figures("moonlit").worst_mag, 0.3);
}

TEST_F(PublishedSky, HasTheTwilightThatItIsBuiltOn) {
  EXPECT_LT(figures("twilight").worst_mag, 0.2);
}

// Published with ranges of 0.4 and 0.6 mag.
TEST_F(PublishedSky, LightsAPlaneInTwilight) {
  const SkyTable& table = this->table("twilight_illuminance");
  ASSERT_EQ(table.rows.size(), 3u);
  EXPECT_NEAR(table.rows[0].cells[0]->difference_mag(), 0.0, 0.4);
  EXPECT_NEAR(table.rows[1].cells[0]->difference_mag(), 0.0, 0.4);
  EXPECT_NEAR(table.rows[2].cells[0]->difference_mag(), 0.0, 0.25);
}

// 5 heights of the Sun, 7 directions: standards that sum up measurements.
TEST_F(PublishedSky, IsThatOfStandardsByDay) {
  EXPECT_EQ(figures("day").cells, 35u);
  EXPECT_LT(figures("day").worst_mag, 0.3);
  EXPECT_LT(figures("day_zenith").worst_mag, 0.3);
}

TEST(SkyFigures, AreOfTheDifferences) {
  const SkyTable table{.name = "t",
                       .title = "T",
                       .about = "",
                       .rows_are = "",
                       .columns = {"a", "b"},
                       .rows = {{"x", {SkyCell{20.0, 20.5}, std::nullopt}},
                                {"y", {SkyCell{20.0, 19.0}, SkyCell{20.0, 20.0}}}}};
  const SkyFigures f = figures_of(table);
  EXPECT_EQ(f.cells, 3u);
  EXPECT_DOUBLE_EQ(f.median_mag, 0.0);
  EXPECT_DOUBLE_EQ(f.worst_mag, 1.0);
  EXPECT_NEAR(f.scatter_mag, 0.7638, 1e-4);
  EXPECT_THAT(sky_section({table}), testing::HasSubstr("| x | 20.00 (-0.50) | |"));
  EXPECT_EQ(figures_of(SkyTable{}).cells, 0u);
}

}  // namespace
}  // namespace dmise
