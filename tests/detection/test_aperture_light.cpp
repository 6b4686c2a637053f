#include "core/detection/light/aperture_light.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

// Reference: Lord Rayleigh 1881, Phil. Mag. 11, 214: 1 - J0(v)^2 - J1(v)^2.
TEST(ApertureLight, OfADiscIsRayleighs) {
  const ApertureLight light(0.0);
  for (const double radius : {0.2, 0.61, 1.22, 2.0, 3.24, 5.0, 9.7, 11.9}) {
    const double j0 = std::cyl_bessel_j(0.0, pi * radius), j1 = std::cyl_bessel_j(1.0, pi * radius);
    EXPECT_NEAR(light.within(radius, 0.0), 1 - j0 * j0 - j1 * j1, 2e-4) << radius;
  }
}

// What an edge diffracts falls with the first power of the distance: the share beyond it is the
// length of the edges over 2 pi^2 times the open area and the distance, on average over rings.
TEST(ApertureLight, FarOutIsThatOfTheEdges) {
  for (const double obscuration : {0.0, 0.2, 0.35, 0.5}) {
    const ApertureLight light(obscuration);
    double mean = 0.0;
    int n = 0;
    for (double radius = 6.0; radius < 12.0; radius += 0.01, ++n)
      mean += (1 - light.within(radius, 0.0)) * radius;
    const double edges = pi * (1 + obscuration), area = pi / 4 * (1 - obscuration * obscuration);
    EXPECT_NEAR(mean / n, edges / (2 * pi * pi * area), 0.02 * mean / n) << obscuration;
  }
}

// A Gaussian blur adds variances: where nearly all light is within, it takes out what the integral
// of the blurred brightness does, here on a grid.
TEST(ApertureLight, ABlurMovesLightOutwards) {
  const ApertureLight light(0.3);
  constexpr double sigma = 0.12, radius = 1.6, step = 0.02;
  double sharp = 0.0, blurred = 0.0;
  for (double x = -2.4; x < 2.4; x += step)
    for (double y = -2.4; y < 2.4; y += step) {
      const double r = std::hypot(x, y), half = step / 2;
      if (r < half) continue;
      const double brightness =
          (light.within(r + half, 0.0) - light.within(r - half, 0.0)) / (2 * pi * r * step);
      sharp += r < radius ? brightness * step * step : 0.0;
      // Share of a Gaussian around (x, y) within the radius, across the nearly straight edge.
      blurred += 0.5 *
                 std::erfc((r - radius + sigma * sigma / (2 * r)) / (std::sqrt(2.0) * sigma)) *
                 brightness * step * step;
    }
  EXPECT_NEAR(light.within(radius, sigma * sigma) - light.within(radius, 0.0), blurred - sharp,
              2e-3);
}

}  // namespace
}  // namespace dmise
