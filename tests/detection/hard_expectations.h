#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "tests/detection/hard_frame.h"

// What a user expects of the streaks of a HardFrame.
namespace dmise::simulated {

/// Tolerances beyond five standard errors of the flux.
struct Tolerance {
  double end_px = 2.0;
  double flux = 0.03;  // relative
};

inline std::string text_of(const Detection& d) {
  const auto number = [](double v) { return std::to_string(v) + " "; };
  return "detection at " + number(d.x_px) + number(d.y_px) + "length " + number(d.length_px) +
         "ends " + number(d.end1_x_px) + number(d.end1_y_px) + number(d.end2_x_px) +
         number(d.end2_y_px) + "signal_e " + number(d.signal_e) + "snr " + number(d.snr);
}

inline double distance_px(PixelPosition a, PixelPosition b) {
  return std::hypot(a.x_px - b.x_px, a.y_px - b.y_px);
}

/// Expects a detection's ends and flux to be those of a streak.
inline void expect_is(const Detection& d, const TrueStreak& s, const Tolerance& tolerance) {
  const PixelPosition a = s.at(-s.length_px / 2), b = s.at(s.length_px / 2);
  const PixelPosition one{d.end1_x_px, d.end1_y_px}, two{d.end2_x_px, d.end2_y_px};
  const double ends_px = std::min(std::max(distance_px(one, a), distance_px(two, b)),
                                  std::max(distance_px(one, b), distance_px(two, a)));
  EXPECT_LT(ends_px, tolerance.end_px) << text_of(d);
  EXPECT_NEAR(d.signal_e, s.flux_e, 5 * d.signal_e / d.snr + tolerance.flux * s.flux_e)
      << text_of(d);
}

/// Expects each streak as one detection with its ends and flux, and no other detection.
inline void expect_streaks_alone(HardFrame& scene, const Tolerance& tolerance = {}) {
  const DetectionResult result = scene.detected();
  std::vector<bool> used(result.detections.size());
  for (const TrueStreak& s : scene.streaks) {
    std::size_t best = used.size();
    for (std::size_t k = 0; k < used.size(); ++k) {
      const auto& d = result.detections[k];
      const double off = distance_px({d.x_px, d.y_px}, {s.x_px, s.y_px});
      if (used[k] || s.distance_px({d.x_px, d.y_px}) > 4) continue;
      if (best == used.size() ||
          off < distance_px({result.detections[best].x_px, result.detections[best].y_px},
                            {s.x_px, s.y_px}))
        best = k;
    }
    if (best == used.size()) {
      ADD_FAILURE() << "not found: streak at " << s.x_px << " " << s.y_px;
      continue;
    }
    used[best] = true;
    expect_is(result.detections[best], s, tolerance);
  }
  for (std::size_t k = 0; k < used.size(); ++k)
    EXPECT_TRUE(used[k]) << "false alarm: " << text_of(result.detections[k]);
}

/// Expects detections on one streak alone, together from one of its ends to the other.
inline void expect_pieces(HardFrame& scene, const TrueStreak& whole, double across_px,
                          double end_px) {
  double least = 1e9, most = -1e9;
  for (const Detection& d : scene.detected().detections)
    for (const PixelPosition p :
         {PixelPosition{d.end1_x_px, d.end1_y_px}, {d.x_px, d.y_px}, {d.end2_x_px, d.end2_y_px}}) {
      EXPECT_LT(std::abs(whole.across(p)), across_px) << text_of(d);
      least = std::min(least, whole.along(p));
      most = std::max(most, whole.along(p));
    }
  EXPECT_NEAR(least, -whole.length_px / 2, end_px);
  EXPECT_NEAR(most, whole.length_px / 2, end_px);
}

/// Expects a streak that leaves a frame of 500 x 500 px as its part inside, flagged.
inline void expect_part_inside(const TrueStreak& streak) {
  HardFrame scene(500, 500, 6);
  scene.add(streak);
  scene.streaks[0] = inside(streak, 500, 500);
  expect_streaks_alone(scene, {.flux = 0.05});
  for (const Detection& d : scene.detected().detections) EXPECT_TRUE(d.at_edge);
}

/// Expects a streak of 300 px that is bent by `sagitta_px` as one, with its light and ends.
inline void expect_bent_streak(double sagitta_px) {
  HardFrame scene(700, 600, 9);
  const TrueStreak s{350, 300, 300, 0.4, 300 * HardFrame::e_per_px};
  scene.add(s, 0, sagitta_px);
  const auto result = scene.detected();
  ASSERT_EQ(result.detections.size(), 1u) << sagitta_px;
  const Detection& d = result.detections[0];
  EXPECT_NEAR(d.signal_e, s.flux_e, 0.05 * s.flux_e);
  EXPECT_LT(distance_px({d.x_px, d.y_px}, {350, 300}), 1.0);
  const double across = -2 * sagitta_px / 3;  // from the chord through the centroid to the ends
  for (const double side : {-1.0, 1.0}) {
    const PixelPosition on = s.at(side * s.length_px / 2);
    const PixelPosition end{on.x_px - across * std::sin(s.angle_rad),
                            on.y_px + across * std::cos(s.angle_rad)};
    EXPECT_LT(std::min(distance_px({d.end1_x_px, d.end1_y_px}, end),
                       distance_px({d.end2_x_px, d.end2_y_px}, end)),
              2.0)
        << text_of(d);
  }
}

}  // namespace dmise::simulated
