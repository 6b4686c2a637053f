#include "core/frames/vec.h"

#include <gtest/gtest.h>

#include "core/frames/earth_orientation.h"

namespace dmise {
namespace {

template <class A, class B>
concept Composable = requires(A a, B b) {
  a* b;
};
template <class A, class B>
concept Addable = requires(A a, B b) {
  a + b;
};
template <class A, class B>
concept Dottable = requires(A a, B b) {
  dot(a, b);
};

TEST(Frames, WrongCompositionDoesNotCompile) {
  static_assert(Composable<Rotation<Itrs, Teme>, Vec<Teme>>);
  static_assert(!Composable<Rotation<Itrs, Teme>, Vec<Gcrs>>);
  static_assert(!Composable<Rotation<Itrs, Teme>, Vec<Itrs>>);
  static_assert(Composable<Rotation<Enu, Itrs>, Rotation<Itrs, Gcrs>>);
  static_assert(!Composable<Rotation<Itrs, Gcrs>, Rotation<Enu, Itrs>>);
  static_assert(!Addable<Vec<Teme>, Vec<Gcrs>>);
  static_assert(!Dottable<Vec<Itrs>, Vec<Gcrs>>);
  static_assert(!std::is_assignable_v<Vec<Gcrs>&, Vec<Teme>>);
}

TEST(Frames, RightAscensionRunsThroughTheFullTurn) {
  EXPECT_EQ(to_spherical(Vec<Gcrs>{1, 0, 0})[0], 0.0);
  EXPECT_NEAR(to_spherical(Vec<Gcrs>{1, -1e-9, 0})[0], 2 * 3.14159265358979 - 1e-9, 1e-13);
  EXPECT_NEAR(to_spherical(Vec<Gcrs>{0, 0, 2})[1], 3.14159265358979 / 2, 1e-13);
  EXPECT_NEAR(angle_rad(from_spherical<Gcrs>(1e-9, 0), from_spherical<Gcrs>(-1e-9, 0)), 2e-9,
              1e-16);
}

}  // namespace
}  // namespace dmise
