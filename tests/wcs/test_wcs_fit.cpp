#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/optics/projection.h"
#include "core/wcs/wcs.h"
#include "core/wcs/wcs_fit.h"

namespace dmise {
namespace {

// A camera at `boresight` whose light is bent as the atmosphere does: 58 arcsec x tan z towards a
// zenith 30 deg from the boresight.
SkyOfPixel refracted(const Optics& optics, const Vec<Gcrs>& boresight, double roll_rad) {
  const Vec<Gcrs> z = unit(boresight);
  const Vec<Gcrs> side =
      unit(cross(z, std::abs(z.x) < 0.5 ? Vec<Gcrs>{1, 0, 0} : Vec<Gcrs>{0, 1, 0}));
  const Vec<Gcrs> other = cross(z, side);
  const Vec<Gcrs> x = std::cos(roll_rad) * side + std::sin(roll_rad) * other;
  const Vec<Gcrs> y = cross(z, x);
  const Vec<Gcrs> zenith = std::cos(30 * deg) * z + std::sin(30 * deg) * x;
  return [=](PixelPosition p) -> std::optional<Vec<Gcrs>> {
    const auto d = unproject(optics, p);
    if (!d) return std::nullopt;
    const Vec<Gcrs> seen = d->x * x + d->y * y + d->z * z;
    const double c = dot(seen, zenith);
    if (c < 0.05) return std::nullopt;
    return unit(seen - zenith * (58 * arcsec / c));
  };
}

Optics camera(Projection projection, double field_deg) {
  return {.projection = projection,
          .focal_length_m = 5.4e-6 * 1663 / std::tan(field_deg / 2 * deg),
          .aperture_m = 0.01,
          .pixel_pitch_m = 5.4e-6,
          .columns = 3326,
          .rows = 2504};
}

TEST(WcsFit, HoldsARefractedGnomonicFieldToAThousandthOfAPixel) {
  for (const Vec<Gcrs>& boresight : {Vec<Gcrs>{1, 0, 0}, Vec<Gcrs>{0.3, -0.8, 0.5},
                                     Vec<Gcrs>{0, 0, 1}, Vec<Gcrs>{1e-4, 0, -1}}) {
    const auto sky = refracted(camera(Projection::gnomonic, 10), boresight, 0.7);
    const Wcs w = fit_wcs(camera(Projection::gnomonic, 10), sky, {.order = 3});
    EXPECT_LT(w.max_px, 1e-3);
    for (PixelPosition p : {PixelPosition{0, 0}, {3325, 1000}, {17.5, 2503}, {1662, 1252}}) {
      const auto back = wcs_pixel(w, *sky(p));
      ASSERT_TRUE(back);
      EXPECT_NEAR(back->x_px, p.x_px, 1e-3);
      EXPECT_NEAR(back->y_px, p.y_px, 1e-3);
    }
  }
}

TEST(WcsFit, A90DegFieldDownTo5DegElevationKeepsWithinATwentiethOfAPixel) {
  const auto sky = refracted(camera(Projection::gnomonic, 90), {0.2, 0.5, 0.6}, 0.1);
  const Wcs w = fit_wcs(camera(Projection::gnomonic, 90), sky, {.order = 5});
  EXPECT_LT(w.rms_px, 0.02);
  EXPECT_LT(w.max_px, 0.05);
  // The residual that the fit states is the one found at a place of its own.
  const PixelPosition p{411.3, 1800.7};
  const auto back = wcs_pixel(w, *sky(p));
  ASSERT_TRUE(back);
  EXPECT_LT(std::hypot(back->x_px - p.x_px, back->y_px - p.y_px), w.max_px * 1.2);
}

TEST(WcsFit, FisheyesOf40DegKeepWithinATenthOfAPixel) {
  for (Projection p : {Projection::equidistant, Projection::equisolid, Projection::stereographic}) {
    const Optics optics = camera(p, 40);
    const Wcs w = fit_wcs(optics, refracted(optics, {0.2, 0.5, 0.6}, 2.0), {.order = 5});
    EXPECT_LT(w.max_px, 0.1) << p.name();
  }
}

TEST(WcsFit, ThePublishedInversePolynomialsInvert) {
  const auto sky = refracted(camera(Projection::gnomonic, 20), {0.2, 0.5, 0.6}, 2.0);
  Wcs w = fit_wcs(camera(Projection::gnomonic, 20), sky, {.order = 5});
  for (PixelPosition p : {PixelPosition{0, 0}, {3325, 1000}, {17.5, 2503}, {1662, 1252}}) {
    Wcs linear = w;  // what a reader that knows AP and BP alone computes
    linear.order = 0;
    linear.a = linear.b = linear.ap = linear.bp = {};
    const auto q = wcs_pixel(linear, *sky(p));
    ASSERT_TRUE(q);
    const double u = q->x_px - w.crpix_x, v = q->y_px - w.crpix_y;
    double x = q->x_px, y = q->y_px;
    for (int i = 0; i <= 5; ++i)
      for (int j = 0; i + j <= 5; ++j) {
        x += w.ap[std::size_t(i * 6 + j)] * std::pow(u, i) * std::pow(v, j);
        y += w.bp[std::size_t(i * 6 + j)] * std::pow(u, i) * std::pow(v, j);
      }
    EXPECT_NEAR(x, p.x_px, 2e-3);
    EXPECT_NEAR(y, p.y_px, 2e-3);
  }
}

}  // namespace
}  // namespace dmise
