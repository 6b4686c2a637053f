#include "core/materials/texture.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"

namespace dmise {
namespace {

// By hand: texel centres of a row of four are at u = 1/8, 3/8, 5/8, 7/8; between them values are
// linear, and beyond the outer ones the row repeats or its edge goes on.
TEST(Texture, IsBilinearBetweenTexelCentres) {
  const LinearPicture row{4, 1, 1, {0.0f, 0.2f, 0.6f, 1.0f}};
  const Texture repeats = colour_texture({}, row), clamped = colour_texture({.clamp = true}, row);
  for (const auto* t : {&repeats, &clamped}) {
    EXPECT_FLOAT_EQ(t->at({0.375f, 0.5f})[0], 0.2f);
    EXPECT_FLOAT_EQ(t->at({0.5f, 0.5f})[1], 0.4f);
    EXPECT_FLOAT_EQ(t->at({0.75f, 0.1f})[2], 0.8f);
  }
  EXPECT_FLOAT_EQ(repeats.at({0.0f, 0.5f})[0], 0.5f);
  EXPECT_FLOAT_EQ(clamped.at({0.0f, 0.5f})[0], 0.0f);
  EXPECT_FLOAT_EQ(repeats.at({2.375f, -3.5f})[0], 0.2f);
  EXPECT_FLOAT_EQ(clamped.at({7.0f, 0.5f})[0], 1.0f);
}

// -mm base gain: base + gain * value of the picture, in heights too.
TEST(Texture, ValuesAreMappedByBaseAndGain) {
  const LinearPicture row{4, 1, 1, {0.0f, 0.2f, 0.6f, 1.0f}};
  const Texture mapped = colour_texture({.base = 0.25, .gain = 0.5}, row);
  EXPECT_FLOAT_EQ(mapped.at({0.375f, 0.5f})[0], 0.35f);
  EXPECT_FLOAT_EQ(mapped.at({0.875f, 0.5f})[0], 0.75f);
  const Texture plain = slope_texture({}, row), halved = slope_texture({.gain = 0.5}, row);
  EXPECT_FLOAT_EQ(halved.at({0.375f, 0.5f})[0], 0.5f * plain.at({0.375f, 0.5f})[0]);
}

TEST(Texture, AReflectanceBeyondOneIsRefused) {
  EXPECT_THROW(colour_texture({}, {1, 1, 1, {1.001f}}), Error);
  EXPECT_THROW(colour_texture({}, {1, 1, 1, {-0.001f}}), Error);
  EXPECT_THROW(colour_texture({}, {1, 1, 1, {NAN}}), Error);
}

// A plane of height u + 2 v has these slopes at every inner texel.
TEST(Texture, SlopesOfAPlaneAreItsGradient) {
  constexpr int side = 8;
  LinearPicture plane{side, side, 1, {}};
  for (int y = 0; y < side; ++y)
    for (int x = 0; x < side; ++x)
      plane.pixels.push_back((float(x) + 2.0f * float(y)) / float(side));
  const Texture slopes = slope_texture({.clamp = true}, plane);
  for (const float place : {0.3f, 0.5f, 0.7f}) {
    EXPECT_NEAR(slopes.at({place, place})[0], 1.0f, 1e-5f);
    EXPECT_NEAR(slopes.at({place, place})[1], 2.0f, 1e-5f);
  }
}

// A triangle whose legs of 2 m and 4 m run along u and v: one repeat over each.
TEST(Texture, GradientsArePerMetre) {
  const auto [u, v] =
      place_gradients({Vec<Body>{0, 0, 0}, {2, 0, 0}, {0, 4, 0}}, {{{0, 0}, {1, 0}, {0, 1}}});
  EXPECT_DOUBLE_EQ(u.x, 0.5);
  EXPECT_DOUBLE_EQ(u.y, 0.0);
  EXPECT_DOUBLE_EQ(v.y, 0.25);
  EXPECT_DOUBLE_EQ(v.x, 0.0);
}

}  // namespace
}  // namespace dmise
