#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>

#include "core/detection/detect.h"
#include "tests/support/simulated_frame.h"

// Light curves along streaks, in frames drawn by brute force. `tests/reference/light_curves.py` has
// GalSim's, for periods, amplitudes and false periods of many streaks.
namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;

constexpr int size = 500;
constexpr double sky_e = 400.0, e_per_px = 700.0, exposure_s = 10.0;

FrameHeader header() {
  FrameHeader h = camera_header(size, size, 8000, 0.6, exposure_s, false);
  h.psf_fwhm_px = 2.5;
  h.read_noise_e = 5.0;
  return h;
}

using Light = std::function<double(double)>;  // at a share of the line, 0 to 1

/// Draws a streak through a place as many short ones.
void add(SimulatedFrame& frame, double x, double y, double length, double angle_rad,
         const Light& light) {
  constexpr double step_px = 0.5;
  const int pieces = int(std::lround(length / step_px));
  for (int i = 0; i < pieces; ++i) {
    const double share = (i + 0.5) / pieces, along = (share - 0.5) * length;
    frame.add_streak(x + along * std::cos(angle_rad), y + along * std::sin(angle_rad),
                     length / pieces, angle_rad, e_per_px * length / pieces * light(share));
  }
}

std::vector<Detection> detections_in(SimulatedFrame& frame, bool light_curves = true) {
  Threads threads(2);
  const CountImage counts = frame.expose();
  return detect(counts, frame.header(), nullptr, threads, nullptr, {.light_curves = light_curves})
      .detections;
}

std::vector<Detection> detections_of(double length, double angle_rad, const Light& light,
                                     unsigned seed) {
  SimulatedFrame frame(header(), size, size, sky_e, seed);
  add(frame, 250.3, 249.6, length, angle_rad, light);
  return detections_in(frame);
}

double sine(double cycles, double share) { return 1 + 0.6 * std::sin(2 * pi * cycles * share); }

TEST(LightCurve, IsOnlyThereWhereItIsAskedFor) {
  SimulatedFrame frame(header(), size, size, sky_e, 1);
  add(frame, 250, 250, 150, 0.5, [](double) { return 1.0; });
  const auto without = detections_in(frame, false);
  ASSERT_EQ(without.size(), 1u);
  EXPECT_FALSE(without[0].light_curve);
}

// An even streak: each bin has its light within its error, and none has a period.
TEST(LightCurve, OfEvenLightIsEvenWithinItsErrors) {
  double squares = 0.0, sum = 0.0;
  int bins = 0, periods = 0;
  for (unsigned seed = 0; seed < 12; ++seed) {
    const auto found = detections_of(
        160, 0.25 * seed, [](double) { return 1.0; }, seed);
    ASSERT_EQ(found.size(), 1u);
    const LightCurve& curve = found[0].light_curve.value();
    periods += curve.period.has_value();
    for (std::size_t i = 1; i + 1 < curve.light_e.size(); ++i) {
      const double off = (curve.light_e[i] - e_per_px * curve.bin_px) / curve.sigma_e[i];
      squares += off * off, sum += off, ++bins;
    }
  }
  EXPECT_GT(bins, 600);
  EXPECT_NEAR(squares / bins, 1.0, 4 * std::sqrt(2.0 / bins) + 0.05);
  EXPECT_NEAR(sum / bins, 0.0, 0.15);
  EXPECT_EQ(periods, 0);
}

// The errors of neighbours are correlated as published: the sum of two bins has their covariance.
TEST(LightCurve, StatesTheCorrelationOfNeighbours) {
  double squares = 0.0, variance = 0.0, alone = 0.0;
  for (unsigned seed = 50; seed < 62; ++seed) {
    const auto found = detections_of(
        160, 0.25 * seed, [](double) { return 1.0; }, seed);
    const LightCurve& curve = found.at(0).light_curve.value();
    for (std::size_t i = 1; i + 2 < curve.light_e.size(); ++i) {
      const double a = curve.light_e[i] - e_per_px * curve.bin_px;
      const double b = curve.light_e[i + 1] - e_per_px * curve.bin_px;
      const double s = curve.sigma_e[i], t = curve.sigma_e[i + 1];
      squares += (a + b) * (a + b);
      alone += s * s + t * t;
      variance += s * s + t * t + 2 * curve.correlation[i] * s * t;
    }
  }
  EXPECT_NEAR(squares / variance, 1.0, 0.2);
  EXPECT_LT(variance, 0.9 * alone);
}

TEST(LightCurve, HasThePeriodOfASineInAnyDirection) {
  unsigned seed = 100;
  for (const double cycles : {2.5, 7.0, 19.0})
    for (const double angle : {0.0, 0.8, 1.57, 2.6}) {
      const auto found = detections_of(
          160, angle, [&](double u) { return sine(cycles, u); }, ++seed);
      ASSERT_EQ(found.size(), 1u) << cycles << ", " << angle;
      const auto& curve = found[0].light_curve;
      ASSERT_TRUE(curve && curve->period) << cycles << ", " << angle;
      const LightPeriod& p = *curve->period;
      EXPECT_NEAR(p.period_px, 160 / cycles, 4.5 * p.period_sigma_px) << cycles << ", " << angle;
      EXPECT_LT(p.period_sigma_px, 0.01 * p.period_px);
      EXPECT_NEAR(p.amplitude, 0.6, 4.5 * p.amplitude_sigma) << cycles << ", " << angle;
      EXPECT_NEAR(p.period_s, exposure_s / cycles, 6 * p.period_sigma_s);
      EXPECT_LT(p.false_alarm, 1e-3);
    }
}

double flash(double share, double at) {
  return 4 * std::exp(-0.5 * std::pow((share - at) / 0.03, 2));
}

// One flash repeats nothing: a shorter period than the way to the farther end would show another.
TEST(LightCurve, OfOneFlashRulesShorterPeriodsOut) {
  for (const double at : {0.25, 0.45, 0.8}) {
    const auto found = detections_of(
        160, 0.4, [&](double u) { return 0.6 + flash(u, at); }, 1);
    ASSERT_EQ(found.size(), 1u);
    const LightCurve& curve = found[0].light_curve.value();
    EXPECT_FALSE(curve.period);
    ASSERT_TRUE(curve.min_period_px) << at;
    const double way_px = 160 * std::max(at, 1 - at);
    EXPECT_LT(*curve.min_period_px, way_px + 15) << at;  // the flash is 11 px long
    EXPECT_GT(*curve.min_period_px, way_px - 15) << at;
    EXPECT_NEAR(*curve.min_period_s, *curve.min_period_px / 160 * exposure_s, 0.5);
  }
}

TEST(LightCurve, HasAPeriodFromTwoFlashesOn) {
  const auto two = detections_of(
      160, 0.4, [&](double u) { return 0.6 + flash(u, 0.2) + flash(u, 0.8); }, 2);
  ASSERT_EQ(two.size(), 1u);
  ASSERT_TRUE(two[0].light_curve.value().period);
  EXPECT_NEAR(two[0].light_curve->period->period_px, 0.6 * 160, 0.01 * 0.6 * 160);
  EXPECT_FALSE(two[0].light_curve->min_period_px);
}

// The errors that are stated of one to two periods are those made.
TEST(LightCurve, StatesTheErrorsOfFewPeriods) {
  double squares = 0.0, of_amplitude = 0.0;
  int count = 0;
  for (unsigned seed = 200; seed < 224; ++seed) {
    const double cycles = 1.2 + 0.05 * (seed - 200);
    const auto found = detections_of(
        160, 0.25 * seed, [&](double u) { return sine(cycles, u + 0.1 * seed); }, seed);
    const auto& curve = found.at(0).light_curve;
    if (!curve || !curve->period) continue;
    const LightPeriod& p = *curve->period;
    squares += std::pow((p.period_px - 160 / cycles) / p.period_sigma_px, 2);
    of_amplitude += std::pow((p.amplitude - 0.6) / p.amplitude_sigma, 2);
    ++count;
  }
  ASSERT_GE(count, 16);
  EXPECT_NEAR(squares / count, 1.0, 4 * std::sqrt(2.0 / count));
  EXPECT_NEAR(of_amplitude / count, 1.0, 4 * std::sqrt(2.0 / count));
}

// Times are those of the ends, also behind a rolling shutter, and run from end 1 to end 2.
TEST(LightCurve, RunsFromEnd1ToEnd2) {
  for (const double angle : {0.3, 0.3 + pi}) {
    SimulatedFrame frame(header(), size, size, sky_e, 5);
    frame.header().detector.emplace().row_time_us = 2000;
    // Bright at the left end.
    add(frame, 250, 250, 160, angle, [&](double u) { return angle < 1 ? 2 - u : 1 + u; });
    const auto found = detections_in(frame);
    ASSERT_EQ(found.size(), 1u);
    const Detection& d = found[0];
    const LightCurve& curve = d.light_curve.value();
    EXPECT_GT(curve.light_e[2], curve.light_e[curve.light_e.size() - 3]);
    EXPECT_TRUE(std::ranges::is_sorted(curve.time_s));
    const double half_bin_s = 0.5 * curve.bin_px / d.length_px * (exposure_s + 0.1);
    EXPECT_NEAR(curve.time_s.front(), d.end1_time.seconds() + half_bin_s, 0.01);
    EXPECT_NEAR(curve.time_s.back(), d.end2_time.seconds() - half_bin_s, 0.01);
  }
}

/// Pieces of a line of `lit` px, `spacing` px apart, as of a body that blinks, or of others where
/// they are uneven.
void add_flashes(SimulatedFrame& frame, int count, double lit, double spacing, double uneven,
                 double cut_px = 0.0) {
  for (int i = 0; i < count; ++i) {
    const double along = (i - 0.5 * (count - 1)) * spacing + (i % 2 ? uneven : 0.0);
    const double cut = i == 0 ? cut_px : 0.0, middle = along + cut / 2;
    frame.add_streak(250 + middle * std::cos(0.6), 250 + middle * std::sin(0.6), lit - cut, 0.6,
                     2 * e_per_px * (lit - cut));
  }
}

TEST(JoinedFlashes, AreOneStreakWithItsPeriod) {
  for (const int count : {4, 6, 9}) {
    SimulatedFrame frame(header(), size, size, sky_e, unsigned(count));
    add_flashes(frame, count, 20, 45, 0, 10);
    const auto found = detections_in(frame);
    ASSERT_EQ(found.size(), 1u) << count;
    EXPECT_NEAR(found[0].length_px, 45 * (count - 1) + 10, 2);
    EXPECT_NEAR(found[0].signal_e, 2 * e_per_px * (20 * count - 10),
                0.02 * 2 * e_per_px * 20 * count);
    ASSERT_TRUE(found[0].light_curve.value().period) << count;
    EXPECT_NEAR(found[0].light_curve->period->period_px, 45, 0.45);
  }
}

// Objects behind each other are equally long.
TEST(JoinedFlashes, AreNotOthersBehindEachOther) {
  SimulatedFrame uneven(header(), size, size, sky_e, 1), even(header(), size, size, sky_e, 2);
  add_flashes(uneven, 5, 20, 45, 9);
  EXPECT_EQ(detections_in(uneven).size(), 5u);
  add_flashes(even, 6, 20, 45, 0);
  EXPECT_EQ(detections_in(even).size(), 6u);
}

// Three flashes of which the exposure has cut one are no three objects, whose streaks are equal.
TEST(JoinedFlashes, MayBeThreeIfOneIsCut) {
  SimulatedFrame frame(header(), size, size, sky_e, 3);
  add(frame, 250, 250, 160, 0.6,
      [](double u) { return u < 0.1 || (u > 0.3 && u < 0.55) || u > 0.75 ? 2.0 : 0.0; });
  EXPECT_EQ(detections_in(frame).size(), 1u);
}

TEST(JoinedFlashes, AreNoRowOfStars) {
  SimulatedFrame frame(header(), size, size, sky_e, 4);
  for (int i = 0; i < 7; ++i) frame.add_star(60.3 + 50 * i, 80.7 + 45 * i, 20000);
  EXPECT_EQ(detections_in(frame).size(), 0u);
}

}  // namespace
}  // namespace dmise
