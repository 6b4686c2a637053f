#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/optics/waves/frozen_flow.h"

namespace dmise {
namespace {

const RngKey key = rng_key(7, "s", 0, "turbulence");

TEST(FrozenFlow, AnyTimeGivesTheSameScreenInAnyOrder) {
  FrozenFlow a(32, 1e9, key), b(32, 1e9, key);
  const double far = 1e6 + 0.3;
  const auto first = a.at(12.0, 0.4, 3.0).phase_rad, last = a.at(far, 0.4, 3.0).phase_rad;
  EXPECT_EQ(b.at(far, 0.4, 3.0).phase_rad, last);
  EXPECT_EQ(b.at(12.0, 0.4, 3.0).phase_rad, first);
  EXPECT_EQ(a.at(12.0, 0.4, 3.0).phase_rad, first);
  EXPECT_NE(first, last);
}

// What stands at x is at x + d after the screen moved by d, but for the slow fading and the tilt.
TEST(FrozenFlow, TheScreenMovesWithTheWind) {
  FrozenFlow flow(64, 1e9, key);
  const PhaseScreen before = flow.at(100.0, 0.0, 6.0), after = flow.at(105.0, 0.0, 6.0);
  // Second differences are blind to tilt.
  double same = 0, moved = 0, power = 0;
  for (int y = 0; y < 64; ++y)
    for (int x = 12; x < 60; ++x) {
      const auto bend = [y](const PhaseScreen& s, int u) {
        return s.at(u - 2, y) - 2 * s.at(u, y) + s.at(u + 2, y);
      };
      power += bend(before, x - 5) * bend(before, x - 5);
      moved += bend(after, x) * bend(before, x - 5);
      same += bend(after, x) * bend(before, x);
    }
  EXPECT_GT(moved / power, 0.98);
  EXPECT_LT(std::abs(same / power), 0.5);
}

TEST(FrozenFlow, IsContinuousWhereOneTorusEndsAndTheNextBegins) {
  FrozenFlow flow(32, 1e9, key);
  const double end = flow.fading_length();
  for (double block : {-1.0, 0.0, 1.0, 2.0, 3.0}) {
    const PhaseScreen a = flow.at(block * end - 1e-6, 0.0, 5.0),
                      b = flow.at(block * end + 1e-6, 0.0, 5.0);
    for (std::size_t i = 0; i < a.phase_rad.size(); ++i)
      ASSERT_NEAR(a.phase_rad[i], b.phase_rad[i], 1e-4);
  }
}

// The aperture meets no part of the air twice, along the axes of the screens neither: second
// differences, which are blind to tilt and to what is larger than the window, are uncorrelated one
// torus and other lengths later. 30 windows of some 100 independent values: 0.02 by chance.
TEST(FrozenFlow, NothingRepeatsInAnyDirection) {
  FrozenFlow flow(32, 1e9, key);
  const auto bends = [&](double distance, double direction_deg) {
    const PhaseScreen s = flow.at(distance, direction_deg * deg, 4.0);
    std::vector<double> all;
    for (int y = 0; y < 32; ++y)
      for (int x = 2; x < 30; ++x) all.push_back(s.at(x - 2, y) - 2 * s.at(x, y) + s.at(x + 2, y));
    return all;
  };
  const double torus = flow.torus(), fading = flow.fading_length();
  for (double direction_deg : {0.0, 90.0, 180.0, 45.0, 30.0})
    for (double lag : {torus, torus - 8, torus - 16, 2 * torus, fading, 2 * fading, 3 * fading}) {
      double ab = 0, aa = 0, bb = 0;
      for (int i = 0; i < 30; ++i) {
        const auto a = bends(37.0 * i, direction_deg), b = bends(37.0 * i + lag, direction_deg);
        for (std::size_t k = 0; k < a.size(); ++k)
          ab += a[k] * b[k], aa += a[k] * a[k], bb += b[k] * b[k];
      }
      EXPECT_LT(std::abs(ab / std::sqrt(aa * bb)), 0.08) << direction_deg << " deg, " << lag;
    }
}

// Over many screen lengths: 6.88 (r / r0)^(5/3), in standard errors of independent screens.
TEST(FrozenFlow, KeepsKolmogorovsStructureFunctionAllTheWay) {
  FrozenFlow flow(24, 1e9, key);
  const int torus = KolmogorovScreens(24).torus();
  for (int r : {2, 8}) {
    double total = 0, total2 = 0;
    const int count = 200;
    for (int i = 0; i < count; ++i) {
      const PhaseScreen s = flow.at(1.37 * torus * i, 0.9, 4.0);
      double d = 0;
      int n = 0;
      for (int y = 0; y < 24; y += 3)
        for (int x = 0; x + r < 24; x += 3) d += std::pow(s.at(x + r, y) - s.at(x, y), 2), ++n;
      total += d / n, total2 += d / n * d / n;
    }
    const double mean = total / count, sigma = std::sqrt((total2 / count - mean * mean) / count);
    EXPECT_NEAR(mean, kolmogorov_structure(r, 4.0), 4 * sigma) << r;
  }
}

// Reference: the spectrum 0.0229 (k^2 + 1 / L0^2)^(-11/6) integrated by Simpson's rule:
// D(r) = 4 pi Int k Phi(k) (1 - J0(2 pi k r)) dk.
TEST(VonKarman, StructureFunctionIsTheTransformOfItsSpectrum) {
  const double outer = 20.0;
  for (double r : {0.05, 0.5, 5.0, 50.0}) {
    double integral = 0;
    const int steps = 200000;
    const double lo = std::log(1e-5), hi = std::log(1e4), h = (hi - lo) / steps;
    for (int i = 0; i <= steps; ++i) {
      const double k = std::exp(lo + i * h), weight = i == 0 || i == steps ? 1 : i % 2 ? 4 : 2;
      integral += weight * k * k * 0.0229 * std::pow(k * k + 1 / (outer * outer), -11.0 / 6) *
                  (1 - std::cyl_bessel_j(0.0, 2 * pi * k * r));
    }
    EXPECT_NEAR(von_karman_structure(r, 1.0, outer) / (4 * pi * integral * h / 3), 1.0, 5e-3) << r;
  }
  EXPECT_NEAR(von_karman_structure(0.01, 0.1, 1e7) / kolmogorov_structure(0.01, 0.1), 1.0, 5e-3);
}

// The tolerance of physics: 3 % from four samples to a third of the screen, 10 % at one.
TEST(PhaseScreen, WithAnOuterScaleTheExpectedStructureFunctionIsVonKarmans) {
  for (double outer : {20.0, 64.0, 200.0, 2000.0}) {
    const KolmogorovScreens screens(64, outer);
    for (int r : {1, 2, 4, 8, 16, 21}) {
      const double expected = von_karman_structure(r, 1.0, outer);
      EXPECT_NEAR(screens.expected_structure(r, 0) / expected, 1.0, r < 4 ? 0.10 : 0.03)
          << outer << " " << r;
    }
  }
}

}  // namespace
}  // namespace dmise
