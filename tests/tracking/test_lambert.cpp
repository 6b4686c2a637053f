#include "core/tracking/initial/lambert.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/numeric/rng.h"
#include "core/base/units.h"
#include "core/orbit/two_body.h"

namespace dmise {
namespace {

double difference(const Vec<Gcrs>& a, const Vec<Gcrs>& b) { return norm(a - b); }

// Curtis, Orbital Mechanics for Engineering Students, example 5.2; his gm of 398600 km^3/s^2 moves
// velocities by less than 0.01 m/s.
TEST(Lambert, AgreesWithCurtis) {
  const auto paths = lambert({5000e3, 10000e3, 2100e3}, {-14600e3, 2500e3, 7000e3}, 3600);
  ASSERT_TRUE(paths) << paths.reason;
  ASSERT_EQ(paths->size(), 1u);
  EXPECT_LT(difference(paths->front().start_velocity_m_per_s, {-5992.5, 1925.4, 3245.6}), 0.2);
}

// Vallado, Fundamentals of Astrodynamics and Applications, example 7-5.
TEST(Lambert, AgreesWithVallado) {
  const auto paths = lambert({15945.34e3, 0, 0}, {12214.83899e3, 10249.46731e3, 0}, 76 * 60.0);
  ASSERT_TRUE(paths) << paths.reason;
  EXPECT_LT(difference(paths->front().start_velocity_m_per_s, {2058.913, 2915.965, 0}), 0.01);
}

// The path must end where it is said to, by the two-body motion of core/orbit.
TEST(Lambert, PathsEndAtTheSecondPlace) {
  const RngKey key = rng_key(7, "lambert", 0, "test");
  std::uint32_t count = 0;
  const auto dice = [&] { return uniform_of(rng_word(key, count++, 0)); };
  int with_turns = 0;
  for (int i = 0; i < 2000; ++i) {
    const auto place = [&] {
      const double r = 6.5e6 * std::pow(10.0, dice());
      return r * from_spherical<Gcrs>(2 * pi * dice(), std::asin(2 * dice() - 1));
    };
    const Vec<Gcrs> start = place(), end = place();
    const double duration_s = 60 * std::pow(2000.0, dice());
    LambertSettings settings;
    settings.max_turns = 3;
    for (const double sense : {1.0, -1.0}) {
      settings.normal = {0, 0, sense};
      const auto paths = lambert(start, end, duration_s, settings);
      ASSERT_TRUE(paths) << paths.reason;
      for (const LambertPath& path : *paths) {
        with_turns += path.turns > 0;
        const TwoBodyState there =
            propagate_two_body({start, path.start_velocity_m_per_s}, duration_s);
        // Speeds of paths through the centre's neighbourhood are large.
        const double speed = norm(path.start_velocity_m_per_s);
        EXPECT_LT(difference(there.position_m, end), 1e-3 + 1e-7 * (norm(end) + speed * duration_s))
            << i << " turns " << path.turns << " sense " << sense;
        EXPECT_GE(dot(cross(start, path.start_velocity_m_per_s), settings.normal), 0) << i;
      }
    }
  }
  EXPECT_GT(with_turns, 1000);
}

TEST(Lambert, HardCasesGiveAPathOrAReason) {
  const Vec<Gcrs> r{7e6, 0, 0};
  EXPECT_EQ(lambert(r, r, 100).reason, "both places are the same");
  EXPECT_EQ(lambert(r, {}, 100).reason, "a place is the Earth's centre");
  EXPECT_EQ(lambert(r, {-8e6, 0, 0}, 3000).reason,
            "the places are opposite: the plane is not determined");
  EXPECT_EQ(lambert(r, {8e6, 0, 0}, 3000).reason,
            "the places are in one direction: the plane is not determined");
  EXPECT_EQ(lambert(r, {0, 7e6, 0}, 0).reason, "the duration is not above 0");
  EXPECT_EQ(lambert(r, {0, NAN, 0}, 10).reason, "a place or the duration is not finite");
  // Nearly opposite, nearly the same, parabolic, far too fast, and very slow.
  const double parabola_s =
      std::sqrt(2.0) / 3 *
      (std::pow(1 + std::sqrt(2.0) / 2, 1.5) - std::pow(1 - std::sqrt(2.0) / 2, 1.5)) *
      std::sqrt(std::pow(7e6, 3) / earth_gm_m3_per_s2);
  for (const double angle : {1e-6, 1e-3, pi / 2, pi - 1e-3, pi - 1e-7, pi + 1e-7, 2 * pi - 1e-5})
    for (const double duration_s : {1e-2, 1.0, parabola_s, 2900.0, 1e5, 1e8}) {
      const Vec<Gcrs> end{7e6 * std::cos(angle), 7e6 * std::sin(angle), 0};
      const auto paths = lambert(r, end, duration_s);
      ASSERT_TRUE(paths) << angle << " " << duration_s << " " << paths.reason;
      for (const LambertPath& path : *paths)
        EXPECT_TRUE(std::isfinite(norm(path.start_velocity_m_per_s)));
    }
}

}  // namespace
}  // namespace dmise
