#include "core/orbit/interpolation.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include "core/orbit/catalogue_interpolation.h"
#include "core/orbit/elements/catalogue.h"
#include "core/orbit/interpolation_error.h"
#include "core/orbit/two_body.h"
#include "tests/support/data.h"

namespace dmise {
namespace {

constexpr HermiteOrder orders[] = {HermiteOrder::cubic, HermiteOrder::quintic,
                                   HermiteOrder::septic};

std::function<Vec<Gcrs>(double)> path_of(const KeplerElements& elements) {
  const TwoBodyState start = state_of(elements);
  return [start](double t_s) { return propagate_two_body(start, t_s).position_m; };
}

Vec<Gcrs> slope_of(const std::function<Vec<Gcrs>(double)>& path, double t_s) {
  return (path(t_s + slope_half_step_s) - path(t_s - slope_half_step_s)) / (2 * slope_half_step_s);
}

/// The greatest distance of a path from its interpolation at `samples` equidistant inner points of
/// each of `intervals` ticks.
double worst_error_m(const std::function<Vec<Gcrs>(double)>& path, HermiteOrder order,
                     double tick_s, int intervals, int samples = 8) {
  const int before = ticks_before(order);
  std::vector<Vec<Gcrs>> positions, slopes;
  for (int k = -before; k < intervals + ticks_behind(order); ++k) {
    positions.push_back(path(k * tick_s));
    slopes.push_back(slope_of(path, k * tick_s));
  }
  double worst_m = 0.0;
  for (int k = 0; k < intervals; ++k)
    for (int s = 1; s <= samples; ++s) {
      const double u = static_cast<double>(s) / (samples + 1);
      const HermiteWeights w = hermite_weights(order, u, tick_s);
      const auto first = static_cast<std::size_t>(k + before + w.first);
      const auto count = static_cast<std::size_t>(w.count);
      const Vec<Gcrs> interpolated =
          interpolate<Gcrs>(w, {positions.data() + first, count}, {slopes.data() + first, count});
      worst_m = std::max(worst_m, norm(interpolated - path((k + u) * tick_s)));
    }
  return worst_m;
}

TEST(Interpolation, PolynomialsOfTheOrderAreExact) {
  for (const HermiteOrder order : orders) {
    const int degree = static_cast<int>(order);
    const auto power = [&](double x) { return std::pow(x, degree); };
    const auto slope = [&](double x) { return degree * std::pow(x, degree - 1); };
    for (const double u : {0.0, 0.1, 0.5, 0.9, 1.0}) {
      const HermiteWeights w = hermite_weights(order, u, 2.0);  // x = tick * 2 + 3
      double sum = 0;
      for (int k = 0; k < w.count; ++k) {
        const double x = (w.first + k) * 2.0 + 3.0;
        sum += w.position[static_cast<std::size_t>(k)] * power(x) +
               w.slope_s[static_cast<std::size_t>(k)] * slope(x);
      }
      EXPECT_NEAR(sum / power(2 * u + 3), 1, 1e-13) << degree << " " << u;
    }
  }
}

TEST(Interpolation, TicksThemselvesAreMetExactly) {
  for (const HermiteOrder order : orders)
    for (const double u : {0.0, 1.0}) {
      const HermiteWeights w = hermite_weights(order, u, 10.0);
      for (int k = 0; k < w.count; ++k) {
        EXPECT_EQ(w.position[static_cast<std::size_t>(k)],
                  w.first + k == static_cast<int>(u) ? 1 : 0);
        EXPECT_EQ(w.slope_s[static_cast<std::size_t>(k)], 0);
      }
    }
}

// The weights of the slope are the derivative of those of the position: exact on polynomials too.
TEST(Interpolation, SlopesOfPolynomialsOfTheOrderAreExact) {
  for (const int count : {2, 3, 4})
    for (const int first : {-2, -1, 0})
      for (const double u : {0.0, 0.3, 0.5, 1.0}) {
        const int degree = 2 * count - 1;
        const HermiteWeights w = hermite_weights(first, count, u, 2.0);  // x = tick * 2 + 9
        double sum = 0;
        for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k) {
          const double x = (first + static_cast<int>(k)) * 2.0 + 9.0;
          sum += w.position_per_s[k] * std::pow(x, degree) +
                 w.slope[k] * degree * std::pow(x, degree - 1);
        }
        EXPECT_NEAR(sum / (degree * std::pow(2 * u + 9, degree - 1)), 1, 1e-10)
            << count << " " << first << " " << u;
      }
}

TEST(Interpolation, TakesTicksOfTheRunOnly) {
  const auto ticks = [](HermiteOrder order, Tick interval, Tick last) {
    const KnotTicks k = knot_ticks(order, interval, last);
    return std::pair(k.first, k.last);
  };
  using P = std::pair<Tick, Tick>;
  EXPECT_EQ(ticks(HermiteOrder::cubic, 4, 9), P(4, 5));
  EXPECT_EQ(ticks(HermiteOrder::quintic, 4, 9), P(3, 5));
  EXPECT_EQ(ticks(HermiteOrder::quintic, 0, 9), P(0, 2));
  EXPECT_EQ(ticks(HermiteOrder::septic, 4, 9), P(3, 6));
  EXPECT_EQ(ticks(HermiteOrder::septic, 0, 9), P(0, 3));
  EXPECT_EQ(ticks(HermiteOrder::septic, 8, 9), P(6, 9));
  EXPECT_EQ(order_within(HermiteOrder::septic, 1), HermiteOrder::cubic);
  EXPECT_EQ(order_within(HermiteOrder::septic, 2), HermiteOrder::quintic);
  EXPECT_EQ(order_within(HermiteOrder::cubic, 9), HermiteOrder::cubic);
  // A time on a tick belongs to the interval that ends there.
  EXPECT_EQ(tick_needed(HermiteOrder::septic, sim_seconds(20), sim_seconds(10), 9), 3);
  EXPECT_EQ(tick_needed(HermiteOrder::cubic, sim_seconds(20), sim_seconds(10), 9), 2);
  EXPECT_EQ(tick_needed(HermiteOrder::septic, sim_seconds(90), sim_seconds(10), 9), 9);
}

// The remainder of the cubic on a circle is r (n h)^4 / 384 at the middle.
TEST(Interpolation, CubicErrorOnACircleIsTheTextbooks) {
  const double r_m = 7e6, h_s = 60, n = std::sqrt(earth_gm_m3_per_s2 / (r_m * r_m * r_m));
  const double error_m =
      worst_error_m(path_of({.periapsis_m = r_m}), HermiteOrder::cubic, h_s, 20, 9);
  EXPECT_NEAR(error_m / (r_m * std::pow(n * h_s, 4) / 384), 1, 0.01);
}

// Each order gains its power of the tick length: what the knob promises.
TEST(Interpolation, ErrorFallsWithTheOrder) {
  const KeplerElements transfer{.periapsis_m = 6.8e6, .eccentricity = 0.3};
  double before_m = 1e9;
  for (const HermiteOrder order : orders) {
    const double coarse = worst_error_m(path_of(transfer), order, 480, 10);
    const double fine = worst_error_m(path_of(transfer), order, 240, 20);
    EXPECT_NEAR(std::log2(coarse / fine), static_cast<int>(order) + 1, 0.5);
    EXPECT_LT(fine, before_m);
    before_m = fine;
  }
}

// A slope 2.6 cm/s off at both ends, as SGP4's velocity is, costs more than all of the cubic's own
// error at 10 s: it must not pass for the derivative.
TEST(Interpolation, VelocityOfAnotherModelIsNoSlope) {
  const auto path = path_of({.periapsis_m = 7e6});
  EXPECT_LT(worst_error_m(path, HermiteOrder::cubic, 10, 20), 5e-4);
  const auto slope = [&](double t) { return slope_of(path, t); };
  const Vec<Gcrs> wrong{0.026, 0, 0};
  const Vec<Gcrs> p =
      interpolate_cubic(0.25, 10, path(0), slope(0) + wrong, path(10), slope(10) + wrong);
  EXPECT_GT(norm(p - path(2.5)), 0.02);
}

// What is stated holds for 979 other real sets, and the longest ticks are those of about a metre.
TEST(CatalogueInterpolation, StatedErrorsHoldForOtherObjects) {
  EXPECT_EQ(longest_tick_s(HermiteOrder::cubic), 60);
  EXPECT_EQ(longest_tick_s(HermiteOrder::quintic), 120);
  EXPECT_EQ(longest_tick_s(HermiteOrder::septic), 180);
  const std::string path = test::catalogue_path("demo.tle");
  const Sgp4Batch batch(read_catalogue(path).elements);
  const Utc start{2458138.5, 0.9861};
  for (const HermiteOrder order : orders)
    for (const double tick_s : {10.0, 60.0, 120.0, 180.0}) {
      const auto error =
          measure_catalogue_interpolation(batch, start, {.order = order, .tick_s = tick_s});
      const double worst_m = stated_interpolation_error(order, tick_s)->worst_m;
      for (const double max_m : error.max_m) EXPECT_LT(max_m, 1.2 * worst_m) << tick_s;
    }
}

// 979 real sets over a whole minute: what the default of a 10 s tick costs.
TEST(CatalogueInterpolation, CubicAt10SecondsIsGoodToCentimetresForRealObjects) {
  const std::string path = test::catalogue_path("demo.tle");
  const Sgp4Batch batch(read_catalogue(path).elements);
  const Utc start{2458138.5, 0.9861};  // 2018-01-20T23:40
  const auto cubic = measure_catalogue_interpolation(batch, start, {.intervals = 6});
  const auto septic = measure_catalogue_interpolation(
      batch, start, {.order = HermiteOrder::septic, .intervals = 6});
  for (std::size_t i = 0; i < batch.size(); ++i) {
    EXPECT_LT(cubic.max_m[i], 0.01) << i;
    EXPECT_LT(septic.max_m[i], 5e-4) << i;
  }
}

}  // namespace
}  // namespace dmise
