#include "sensors/survey/trail_in_frame.h"

#include <gtest/gtest.h>

namespace dmise {
namespace {

const Optics optics = [] {
  Optics o;
  o.columns = 100;
  o.rows = 80;
  return o;
}();

ObjectSample at(double x, double y, double electrons_per_s) {
  ObjectSample s;
  s.pixel = PixelPosition{x, y};
  s.electrons_per_s = electrons_per_s;
  return s;
}

TEST(TrailInFrame, AWholeStraightTrailHasItsLengthAndLight) {
  const auto trail =
      trail_in_frame(std::vector{at(10, 10, 5), at(25, 30, 5), at(40, 50, 5)}, 4.0, optics);
  EXPECT_NEAR(trail.signal_e, 20.0, 1e-12);
  EXPECT_NEAR(trail.length_px, 50.0, 1e-9);
  EXPECT_NEAR(trail.centroid.x_px, 25.0, 1e-9);
  EXPECT_NEAR(trail.centroid.y_px, 30.0, 1e-9);
}

// Half of it is left of the frame's edge at -0.5.
TEST(TrailInFrame, TheFrameCutsIt) {
  const auto trail =
      trail_in_frame(std::vector{at(-32.5, 40, 5), at(-0.5, 40, 5), at(31.5, 40, 5)}, 4.0, optics);
  EXPECT_NEAR(trail.signal_e, 10.0, 0.7);
  EXPECT_NEAR(trail.length_px, 32.0, 2.1);
}

TEST(TrailInFrame, WithoutPlaceOrLightThereIsNone) {
  EXPECT_EQ(trail_in_frame(std::vector{at(10, 10, 0), at(20, 10, 0), at(30, 10, 0)}, 1.0, optics)
                .signal_e,
            0.0);
  EXPECT_EQ(trail_in_frame(std::vector{at(10, 10, 1), ObjectSample{}, at(30, 10, 1)}, 1.0, optics)
                .signal_e,
            0.0);
  const auto point =
      trail_in_frame(std::vector{at(10, 10, 1), at(10, 10, 1), at(10, 10, 1)}, 2.0, optics);
  EXPECT_NEAR(point.signal_e, 2.0, 1e-12);
  EXPECT_EQ(point.length_px, 0.0);
}

}  // namespace
}  // namespace dmise
