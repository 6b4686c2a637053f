#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include "core/detection/detect.h"
#include "core/products/product_json.h"
#include "tests/support/simulated_frame.h"

// A frame of hard conditions with the streaks that are truly in it, and what a user expects of
// them.
namespace dmise::simulated {

/// A streak as it was drawn; `length_px` is between the ends, `flux_e` all of its light.
struct TrueStreak {
  double x_px = 0.0, y_px = 0.0, length_px = 0.0, angle_rad = 0.0, flux_e = 0.0;

  PixelPosition at(double along_px) const {
    return {x_px + along_px * std::cos(angle_rad), y_px + along_px * std::sin(angle_rad)};
  }
  double along(PixelPosition p) const {
    return (p.x_px - x_px) * std::cos(angle_rad) + (p.y_px - y_px) * std::sin(angle_rad);
  }
  double across(PixelPosition p) const {
    return (p.y_px - y_px) * std::cos(angle_rad) - (p.x_px - x_px) * std::sin(angle_rad);
  }
  double distance_px(PixelPosition p) const {
    return std::hypot(across(p), std::max(std::abs(along(p)) - length_px / 2, 0.0));
  }
};

/// All-sky camera on a fixed mount: 20 s in which stars trail by 2.4 px.
inline FrameHeader hard_header(int columns, int rows) {
  return camera_header(columns, rows, 1663.0, 34 * deg, 20, true);
}

class HardFrame {
 public:
  static constexpr double sky_e = 1500.0, e_per_px = 500.0;

  HardFrame(int columns, int rows, unsigned seed)
      : frame(hard_header(columns, rows), columns, rows, sky_e, seed) {}

  void add(const TrueStreak& s, double slope = 0.0, double sagitta_px = 0.0) {
    frame.add_streak(s.x_px, s.y_px, s.length_px, s.angle_rad, s.flux_e, slope, sagitta_px);
    streaks.push_back(s);
  }
  /// A streak of `e_per_px`.
  void add(double x_px, double y_px, double length_px, double angle_rad) {
    add({x_px, y_px, length_px, angle_rad, e_per_px * length_px});
  }
  /// Whether a place is at least `px` from each streak.
  bool is_clear(PixelPosition place, double px) const {
    return std::all_of(streaks.begin(), streaks.end(),
                       [&](const TrueStreak& s) { return s.distance_px(place) >= px; });
  }
  /// `count` stars of the same flux at random places, at least `clear_px` from streaks.
  void add_stars(int count, double flux_e, double clear_px) {
    const auto& electrons = frame.expected();
    for (int placed = 0; placed < count;) {
      const PixelPosition p{frame.uniform(0, electrons.columns), frame.uniform(0, electrons.rows)};
      if (!is_clear(p, clear_px)) continue;
      frame.add_star(p.x_px, p.y_px, flux_e);
      ++placed;
    }
  }
  /// Multiplies or adds by place: `change(electrons, x, y)`.
  template <class Change>
  void change(const Change& change) {
    auto& e = frame.expected();
    for (int y = 0; y < e.rows; ++y)
      for (int x = 0; x < e.columns; ++x) e.at(x, y) = float(change(e.at(x, y), x, y));
  }
  /// Charge above the full well flows along its column, half of it each way.
  void bloom() {
    frame.header().detector.emplace().blooming = true;
    auto& e = frame.expected();
    const double well = frame.header().full_well_e, full = well + 10 * std::sqrt(well);
    for (int x = 0; x < e.columns; ++x)
      for (const int step : {1, -1}) {
        double carried = 0.0;
        for (int y = step > 0 ? 0 : e.rows - 1; y >= 0 && y < e.rows; y += step) {
          const double room = well - e.at(x, y);
          if (room > 0 && carried > 0) {
            e.at(x, y) = float(carried >= room ? full : e.at(x, y) + carried);
            carried = std::max(carried - room, 0.0);
          } else if (room < 0 && e.at(x, y) != float(full)) {
            carried -= room / 2;
            if (step < 0) e.at(x, y) = float(full);
          }
        }
      }
  }
  DetectionResult detected() {
    const DetectionResult result = detect(frame.expose(), frame.header(), {}, threads_);
    // A NaN is no JSON: to_json throws for it.
    for (const Detection& d : result.detections)
      EXPECT_NO_THROW(to_json(d, [](SimTime) { return std::string(); }));
    EXPECT_NO_THROW(to_json(result.report, [](SimTime) { return std::string(); }));
    return result;
  }

  SimulatedFrame frame;
  std::vector<TrueStreak> streaks;

 private:
  Threads threads_{2};
};

/// The part of a streak that is inside a frame, cut at its pixels' outer edges.
inline TrueStreak inside(const TrueStreak& s, int columns, int rows) {
  double from = s.length_px / 2, to = -s.length_px / 2;
  for (double a = -s.length_px / 2; a <= s.length_px / 2; a += 0.01) {
    const auto [x, y] = s.at(a);
    if (x < -0.5 || y < -0.5 || x > columns - 0.5 || y > rows - 0.5) continue;
    from = std::min(from, a);
    to = std::max(to, a);
  }
  const PixelPosition middle = s.at((from + to) / 2);
  return {middle.x_px, middle.y_px, to - from, s.angle_rad, s.flux_e * (to - from) / s.length_px};
}

/// `count` pieces of `piece_px` on one line, one behind the other with gaps of `gap_px`; returns
/// the streak from the first to the last.
inline TrueStreak add_row(HardFrame& scene, PixelPosition first, int count, double piece_px,
                          double gap_px) {
  constexpr double angle = 0.4;
  const double pitch_px = piece_px + gap_px;
  for (int i = 0; i < count; ++i)
    scene.add(first.x_px + pitch_px * i * std::cos(angle),
              first.y_px + pitch_px * i * std::sin(angle), piece_px, angle);
  TrueStreak whole = scene.streaks.back();
  const PixelPosition middle = whole.at(-pitch_px * (count - 1) / 2);
  return {middle.x_px, middle.y_px, pitch_px * (count - 1) + piece_px, angle, count * whole.flux_e};
}

/// A streak of 200 px and its copy `apart_px` beside it.
inline void add_pair(HardFrame& scene, double apart_px, double angle) {
  scene.add(300, 300, 200, angle);
  scene.add(300 - apart_px * std::sin(angle), 300 + apart_px * std::cos(angle), 200, angle);
}

/// The Moon: a saturated disc of 60 px in a glow over the whole frame of 1000 x 900 px.
inline void add_moon(HardFrame& scene) {
  scene.change([](double e, int x, int y) {
    const double r = std::hypot(x - 520.0, y - 430.0);
    const double disc = 0.5 * (1 + std::erf((60 - r) / 1.5));
    return e + 60000 * disc + 8000 / (1 + r * r / 14400) + 2 * x;
  });
}

/// Three streaks in the open, of a frame of at least 800 x 700 px.
inline void add_three_streaks(HardFrame& scene) {
  scene.add(180, 150, 120, 0.4);
  scene.add(600, 230, 150, 2.1);
  scene.add(330, 560, 90, -0.9);
}

}  // namespace dmise::simulated
