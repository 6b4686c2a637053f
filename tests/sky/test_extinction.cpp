#include "core/sky/air/extinction.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/photometry/magnitude.h"
#include "core/photometry/spectrum.h"
#include "core/photometry/star_light.h"

namespace dmise {
namespace {

// The curves' own values: Lick 0.177 at 555.6 nm, Kitt Peak 0.268 at 437.0, Mauna Kea 0.106 at 550.
TEST(Extinction, SitesHaveTheirObservatoriesCurves) {
  EXPECT_NEAR(extinction_of_site("lick")->at_or_end(555.6 * nm), 0.177, 0.003);
  EXPECT_NEAR(extinction_of_site("kitt_peak")->at_or_end(437.0 * nm), 0.268, 0.006);
  EXPECT_NEAR(extinction_of_site("mauna_kea")->at_or_end(550.0 * nm), 0.106, 0.002);
  EXPECT_FALSE(extinction_of_site("atlantis"));
  EXPECT_EQ(extinction_site_names().size(), 6u);
  EXPECT_NEAR(zenith_extinction_mag(johnson_v(), *extinction_of_site("lick")), 0.177, 0.006);
  EXPECT_NEAR(extinction_scaled_to(0.3).at_or_end(550 * nm), 0.3, 1e-12);
}

TEST(Extinction, AGreyAirFollowsBeersLaw) {
  const BandExtinction grey(johnson_v(), {{400 * nm, 700 * nm}, {0.2, 0.2}});
  for (const double x : {0.0, 0.3, 1.0, 2.0, 10.0, 37.9})
    EXPECT_NEAR(grey.of_star(x, 0.3), std::pow(10, -0.4 * 0.2 * x), 1e-6) << x;
}

// Against the integral itself, of stars' spectra through the band behind the air.
TEST(Extinction, TheTableIsTheIntegral) {
  const Curve curve = *extinction_of_site("kitt_peak");
  const Band clear{"clear", 0.65 * um, 0.5 * um, {}};
  for (const Band& band : {*filter_named("bessell-B"), *filter_named("sdss-r"), clear}) {
    const BandExtinction air(band, curve);
    for (const double x : {0.0, 1.0, 1.7, 3.0, 10.0, 37.9})
      for (const double bv : {-0.3, 0.0, 0.65, 1.7}) {
        const StarSpectrum star = star_spectrum(bv);
        const double expected =
            photon_rate(star, through(band, air_transmission(curve, x))) / photon_rate(star, band);
        EXPECT_NEAR(air.of_star(x, bv), expected, x > 5 ? 0.02 * expected : 0.002)
            << band.name << x;
      }
  }
}

TEST(Extinction, RedderStarsLoseLessAndNothingIsNan) {
  const BandExtinction air(*filter_named("bessell-U"), *extinction_of_site("lick"));
  EXPECT_GT(air.of_star(3.0, 1.5), air.of_star(3.0, -0.3));
  for (const double x : {-1.0, 0.0, 37.9, 1e9})
    for (const double bv : {-9.0, double(NAN), 9.0}) {
      EXPECT_GT(air.of_star(x, bv), 0.0);
      EXPECT_LE(air.of_star(x, bv), 1.0);
    }
}

}  // namespace
}  // namespace dmise
