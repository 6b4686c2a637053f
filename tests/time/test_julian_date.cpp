#include "core/time/julian_date.h"

#include <gtest/gtest.h>

#include <type_traits>

namespace dmise {
namespace {

template <class A, class B>
concept Subtractable = requires(A a, B b) {
  days_between(a, b);
};

TEST(JulianDate, ScalesDoNotMix) {
  static_assert(!std::is_convertible_v<Utc, Tt>);
  static_assert(!std::is_convertible_v<Tai, Tt>);
  static_assert(!std::is_constructible_v<Ut1, Utc>);
  static_assert(Subtractable<Tt, Tt>);
  static_assert(!Subtractable<Tt, Tai>);
  static_assert(!Subtractable<Utc, Utc>, "days of UTC differ in length");
}

TEST(JulianDate, JulianYearsCountFromJ2000) {
  EXPECT_DOUBLE_EQ(julian_years_since_j2000({2451544.5, 0.5}), 0.0);
  EXPECT_DOUBLE_EQ(julian_years_since_j2000({2451544.5 + 36525.0, 0.5}), 100.0);
}

}  // namespace
}  // namespace dmise
