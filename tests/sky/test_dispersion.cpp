#include "core/sky/air/dispersion.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"
#include "core/sky/air/airmass.h"
#include "core/sky/air/extinction.h"

namespace dmise {
namespace {

const Weather air_of_a_mountain{.pressure_hpa = 780.0, .temperature_c = 10.0, .humidity = 0.3};

Band band_named(const std::string& name) {
  return name == "open" ? Band{"open", 650 * nm, 500 * nm, {}} : *filter_named("bessell-" + name);
}

Dispersion dispersion_in(const Band& band, const Curve& extinction = {}) {
  return {band, extinction, Refraction(air_of_a_mountain, band.centre_m / um), true};
}

struct Spectrum {
  double mean_arcsec = 0.0, rms_arcsec = 0.0, light = 0.0;
};

/// Spectrum of a source at an elevation, cut into cells.
Spectrum spectrum(const Dispersion& dispersion, double elevation_rad, double bv, int count) {
  std::vector<SpectrumCell> cells;
  dispersion.band().add_cells(airmass(elevation_rad), bv, count, cells);
  const auto [blue_rad, red_rad] = dispersion.ends(elevation_rad);
  Spectrum sum;
  double squares = 0.0;
  for (const auto& [at, share] : cells) {
    const double up = std::lerp(blue_rad, red_rad, at) / arcsec;
    sum.light += share;
    sum.mean_arcsec += share * up;
    squares += share * up * up;
  }
  sum.rms_arcsec = std::sqrt(std::max(0.0, squares - sum.mean_arcsec * sum.mean_arcsec));
  return sum;
}

struct Row {
  const char *band, *spectrum;
  double bv, zenith_deg, mean_arcsec, rms_arcsec;
};
constexpr Row rows[] = {
#include "tests/sky/dispersion_reference.inc"
};

// Reference: ERFA's refco at every wavelength of the band, weighted by spectra behind the same air
// (tests/reference/dispersion.py).
TEST(Dispersion, IsErfasRefractionOverTheBand) {
  for (const Row& row : rows) {
    const auto dispersion = dispersion_in(band_named(row.band), *extinction_of_site("ctio"));
    const Spectrum ours =
        spectrum(dispersion, (90 - row.zenith_deg) * deg, row.bv, BandDispersion::max_cells);
    const std::string where =
        std::string(row.band) + " of " + row.spectrum + " at " + std::to_string(row.zenith_deg);
    // Spectra of stars by B-V are smooth: Vega's lines and Balmer jump are not in them.
    const bool is_rough = std::string(row.spectrum) == "Vega" && row.band[0] < 'I';
    const bool is_jump = std::string(row.spectrum) == "Sun" || std::string(row.spectrum) == "Vega";
    const double tolerance = row.band[0] == 'U' && is_jump ? 0.11 : is_rough ? 0.08 : 0.02;
    EXPECT_NEAR(ours.mean_arcsec, row.mean_arcsec, tolerance) << where;
    EXPECT_NEAR(ours.rms_arcsec, row.rms_arcsec, tolerance) << where;
    EXPECT_NEAR(ours.light, 1.0, 1e-12) << where;
  }
}

// A star's mean place is that of all its light, however it is cut; the width is missed by less than
// a cell makes.
TEST(Dispersion, CellsKeepLightAndCentroid) {
  const auto dispersion = dispersion_in(band_named("B"));
  const double elevation = 25 * deg;
  const Spectrum whole = spectrum(dispersion, elevation, 1.4, BandDispersion::max_cells);
  const auto [blue_rad, red_rad] = dispersion.ends(elevation);
  for (const int count : {1, 2, 8, 32}) {
    const Spectrum cut = spectrum(dispersion, elevation, 1.4, count);
    EXPECT_NEAR(cut.light, 1.0, 1e-12);
    EXPECT_NEAR(cut.mean_arcsec, whole.mean_arcsec, 1e-9) << count;
    const double cell_arcsec = (blue_rad - red_rad) / arcsec / count;
    EXPECT_LE(whole.rms_arcsec * whole.rms_arcsec - cut.rms_arcsec * cut.rms_arcsec,
              cell_arcsec * cell_arcsec / 4)
        << count;
  }
}

TEST(Dispersion, ABlueStarIsLiftedMoreThanARedOne) {
  const auto dispersion = dispersion_in(band_named("B"));
  EXPECT_GT(spectrum(dispersion, 30 * deg, -0.3, 1).mean_arcsec,
            spectrum(dispersion, 30 * deg, 1.6, 1).mean_arcsec + 0.1);
}

TEST(Dispersion, IsNothingInTheZenithAndWithoutAir) {
  const auto dispersion = dispersion_in(band_named("V"));
  EXPECT_NEAR(dispersion.ends(90 * deg).blue_rad, 0.0, 1e-12);
  EXPECT_NEAR(dispersion.ends(90 * deg).red_rad, 0.0, 1e-12);
  const Band band = band_named("V");
  const Dispersion none(band, {}, Refraction(), true);
  EXPECT_EQ(none.ends(5 * deg).blue_rad, 0.0);
  EXPECT_EQ(none.ends(5 * deg).red_rad, 0.0);
  EXPECT_FALSE(Dispersion::applies({.on_ground = false}));
}

// At and below the horizon: 2 % of the refraction of half a degree across a wide band.
TEST(Dispersion, AtTheHorizonIsFiniteAndOrdered) {
  for (const auto& extinction : {Curve{}, *extinction_of_site("lick")}) {
    const auto dispersion = dispersion_in({"wide", 1400 * nm, 2200 * nm, {}}, extinction);
    double last = 0.0;
    for (const double elevation_deg : {60.0, 30.0, 10.0, 3.0, 1.0, 0.0}) {
      const auto [blue_rad, red_rad] = dispersion.ends(elevation_deg * deg);
      EXPECT_GT(blue_rad, 0.0);
      EXPECT_LT(red_rad, 0.0);
      EXPECT_GT(blue_rad - red_rad, last);
      last = blue_rad - red_rad;
    }
    EXPECT_GT(last, 60 * arcsec);
    EXPECT_LT(last, 200 * arcsec);
    for (const double elevation_deg : {0.0, -1.0, -20.0})
      for (const double bv : {-9.0, 0.65, double(NAN), 9.0}) {
        const Spectrum s = spectrum(dispersion, elevation_deg * deg, bv, 128);
        EXPECT_NEAR(s.light, 1.0, 1e-9);
        EXPECT_TRUE(std::isfinite(s.mean_arcsec) && std::isfinite(s.rms_arcsec));
      }
  }
}

TEST(Dispersion, ABandOfOneNanometreIsAPoint) {
  const auto dispersion = dispersion_in({"line", 656.3 * nm, 1 * nm, {}});
  const Spectrum s = spectrum(dispersion, 20 * deg, 0.65, 128);
  EXPECT_NEAR(s.light, 1.0, 1e-9);
  EXPECT_NEAR(s.mean_arcsec, 0.0, 1e-3);
  EXPECT_LT(s.rms_arcsec, 0.01);
}

// A level cuts a spectrum into no wider pieces than it says.
TEST(Dispersion, LevelsAreWidthsOfCells) {
  EXPECT_EQ(Dispersion::cells(1, 1000.0), 1);
  EXPECT_EQ(Dispersion::cells(2, 0.5), 1);
  EXPECT_EQ(Dispersion::cells(2, 3.0), 4);
  EXPECT_EQ(Dispersion::cells(4, 3.0), 32);
  EXPECT_EQ(Dispersion::cells(4, 1e9), BandDispersion::max_cells);
}

}  // namespace
}  // namespace dmise
