#include "sensors/survey/shells.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

MeanElements orbit(double turns_a_day, double eccentricity = 0.001) {
  return {.mean_motion_rad_per_min = turns_a_day * 2 * pi / 1440.0, .eccentricity = eccentricity};
}

ObjectPopulation population_of(const std::vector<MeanElements>& elements, std::size_t own = 0) {
  ObjectPopulation p;
  p.elements = elements;
  p.roster.objects.resize(elements.size() + own);
  return p;
}

// The International Space Station's 15.5 turns a day are 413 km (NASA gives 400 to 420),
// Starlink's 15.06 550 km, a GPS satellite's 2.0056 20,180 km.
TEST(Shells, AltitudeFollowsFromMeanMotion) {
  EXPECT_NEAR(mean_altitude_km(orbit(15.5)), 413.0, 10.0);
  EXPECT_NEAR(mean_altitude_km(orbit(15.06)), 550.0, 5.0);
  EXPECT_NEAR(mean_altitude_km(orbit(2.0056)), 20180.0, 10.0);
}

TEST(Shells, EveryObjectIsInOne) {
  const auto shells = shells_of(population_of({orbit(15.5), orbit(15.06), orbit(14.2), orbit(2.0),
                                               orbit(1.0027), orbit(2.0, 0.7), orbit(0.3)},
                                              2),
                                {450.0, 600.0});
  std::vector<std::string> names;
  for (const auto i : shells.of_object) names.push_back(shells.shells[i].name);
  EXPECT_EQ(names,
            (std::vector<std::string>{"below 450 km", "450-600 km", "LEO above 600 km", "MEO",
                                      "GEO", "HEO", "beyond GEO", "own motion", "own motion"}));
  std::size_t sum = 0;
  for (const auto& shell : shells.shells) sum += shell.objects;
  EXPECT_EQ(sum, names.size());
}

TEST(Shells, WithoutLimitsLowOrbitsAreOneShell) {
  const auto shells = shells_of(population_of({orbit(15.5), orbit(12.5)}), {});
  EXPECT_EQ(shells.shells[shells.of_object[0]].name, "LEO");
  EXPECT_EQ(shells.of_object[0], shells.of_object[1]);
  EXPECT_TRUE(shells_of({}, {}).of_object.empty());
}

}  // namespace
}  // namespace dmise
