#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/wcs/wcs.h"

namespace dmise {
namespace {

// Reference: astropy 5.2 WCS (wcslib) with these keywords, tests/reference/wcs_values.py.
Wcs distorted(double ra_deg, double dec_deg) {
  Wcs w;
  w.crpix_x = 255.5;
  w.crpix_y = 199.5;
  w.ra_rad = ra_deg * deg;
  w.dec_rad = dec_deg * deg;
  w.cd_deg = {-0.02, 0.003, 0.004, 0.021};
  w.order = 3;
  w.a.assign(16, 0.0);
  w.b.assign(16, 0.0);
  w.a[2] = 1e-5;  // A_0_2
  w.a[1 * 4 + 1] = -2e-5;
  w.a[3 * 4 + 0] = 3e-8;
  w.b[2 * 4 + 0] = 1.5e-5;
  w.b[0 * 4 + 3] = -2e-8;
  return w;
}

struct Case {
  double ra_deg, dec_deg, x, y, expected_ra_deg, expected_dec_deg;
};

constexpr Case cases[] = {
#include "tests/reference/wcs_values.inc"
};

TEST(Wcs, AgreesWithAstropyAlsoAtThePoleAndAcrossTheWrap) {
  for (const Case& c : cases) {
    const Vec<Gcrs> got = wcs_direction(distorted(c.ra_deg, c.dec_deg), {c.x, c.y});
    const auto expected = from_spherical<Gcrs>(c.expected_ra_deg * deg, c.expected_dec_deg * deg);
    EXPECT_LT(angle_rad(got, expected), 1e-6 * arcsec) << c.ra_deg << " " << c.dec_deg;
  }
}

TEST(Wcs, PixelIsTheInverseOfDirectionWithoutInversePolynomials) {
  for (const Case& c : cases) {
    const Wcs w = distorted(c.ra_deg, c.dec_deg);
    const auto back = wcs_pixel(w, wcs_direction(w, {c.x, c.y}));
    ASSERT_TRUE(back);
    EXPECT_NEAR(back->x_px, c.x, 1e-7);
    EXPECT_NEAR(back->y_px, c.y, 1e-7);
  }
}

TEST(Wcs, ADirectionBehindTheTangentPlaneHasNoPixel) {
  const Wcs w = distorted(10, 20);
  EXPECT_FALSE(wcs_pixel(w, -wcs_direction(w, {255.5, 199.5})));
  EXPECT_FALSE(wcs_pixel(w, cross(wcs_direction(w, {255.5, 199.5}), Vec<Gcrs>{0, 0, 1})));
}

}  // namespace
}  // namespace dmise
