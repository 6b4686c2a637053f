#include "launch/survey/coastlines.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

double distance_deg(double longitude_deg, double latitude_deg) {
  double least = 1e9;
  for (const auto& line : coastlines())
    for (const CoastPoint& at : line)
      least = std::min(least, std::hypot((0.1 * at.longitude - longitude_deg) *
                                             std::cos(latitude_deg * 0.0174533),
                                         0.1 * at.latitude - latitude_deg));
  return least;
}

// Reference: places of capes in gazetteers.
TEST(Coastlines, PassCapesAndNoOpenSeaOrInnerLand) {
  const double capes[][2] = {{18.47, -34.36}, {-67.28, -55.98}, {25.78, 71.17}, {142.53, -10.69},
                             {-5.72, 50.07},  {77.54, 8.08},    {-68.4, 12.3},  {166.7, -77.5}};
  for (const auto& [longitude, latitude] : capes)
    EXPECT_LT(distance_deg(longitude, latitude), 1.5) << longitude << " " << latitude;
  const double far[][2] = {{-150.0, 0.0}, {-35.0, 0.0}, {90.0, 48.0}, {-100.0, 45.0}};
  for (const auto& [longitude, latitude] : far)
    EXPECT_GT(distance_deg(longitude, latitude), 3.0) << longitude << " " << latitude;
}

}  // namespace
}  // namespace dmise
