#include "core/sky/stars/star_catalogue.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

// Barnard's star: Hipparcos (CDS I/239, HIP 87937, epoch J1991.25) against SIMBAD's place of
// J2000.0, 17 57 48.49803 +04 41 36.2072. Their proper motions differ by 1.4 mas/yr, so 20 mas
// over 8.75 years.
TEST(StarCatalogue, MovesBarnardsStarFromHipparcosEpochToJ2000) {
  StarCatalogue c;
  ASSERT_EQ(append_star(c, {.id = 87937,
                            .ra_rad = 269.45402305 * deg,
                            .dec_rad = 4.66828815 * deg,
                            .pm_ra_cosdec_rad_per_yr = -797.84 * mas,
                            .pm_dec_rad_per_yr = 10326.93 * mas,
                            .v_mag = 9.54}),
            nullptr);
  move_star(c, 0, 1991.25, 2000.0);
  EXPECT_NEAR(c.ra_rad[0], (17 + 57 / 60.0 + 48.49803 / 3600) * 15 * deg, 20 * mas);
  EXPECT_NEAR(c.dec_rad[0], (4 + 41 / 60.0 + 36.2072 / 3600) * deg, 20 * mas);
}

TEST(StarCatalogue, MotionAcrossThePoleIsStraight) {
  StarCatalogue c;
  ASSERT_EQ(append_star(c, {.ra_rad = 1.0,
                            .dec_rad = 90 * deg - 5 * arcsec,
                            .pm_ra_cosdec_rad_per_yr = 0.0,
                            .pm_dec_rad_per_yr = 1 * arcsec}),
            nullptr);
  move_star(c, 0, 2000.0, 2010.0);
  EXPECT_NEAR(c.dec_rad[0], 90 * deg - 5 * arcsec, 1e-3 * mas);
  EXPECT_NEAR(c.ra_rad[0], 1.0 + pi, 1e-9);
  EXPECT_NEAR(c.pm_dec_rad_per_yr[0], -1 * arcsec, 1e-3 * mas);  // southwards now
}

TEST(StarCatalogue, WhatIsMissingGetsItsStatedDefaultAndAFlag) {
  StarCatalogue c;
  ASSERT_EQ(append_star(c, {.spectral_type = ""}), nullptr);
  ASSERT_EQ(append_star(c, {.spectral_type = "G0V"}), nullptr);
  EXPECT_EQ(c.flags[0], star_has_no_colour | star_has_no_parallax | star_has_no_proper_motion);
  EXPECT_FLOAT_EQ(c.bv[0], default_star_bv);
  EXPECT_NEAR(c.bv[1], 0.58, 1e-6);  // Fitzgerald 1970
  EXPECT_FALSE(bv_of_spectral_type("N0"));
}

TEST(StarCatalogue, RedStarsAreDwarfsOrGiants) {
  const auto kind = [](double v_mag, double bv, double parallax_mas, std::string_view type) {
    StarCatalogue c;
    StarRecord star{.v_mag = v_mag, .bv = bv, .spectral_type = type};
    if (parallax_mas != 0.0) star.parallax_rad = parallax_mas * mas;
    EXPECT_EQ(append_star(c, star), nullptr);
    return c.colour(0).kind;
  };
  // Hipparcos: Betelgeuse, Arcturus, 61 Cygni A, Barnard's star, the Sun's like 18 Scorpii.
  EXPECT_EQ(kind(0.45, 1.50, 7.6, "M2"), m_giant(2));
  EXPECT_EQ(kind(-0.05, 1.24, 88.8, "K2"), StarKind::most);
  EXPECT_EQ(kind(5.20, 1.07, 287.1, "K5"), StarKind::red_dwarf);
  EXPECT_EQ(kind(9.54, 1.57, 549.0, "sd"), StarKind::red_dwarf);
  EXPECT_EQ(kind(9.54, 1.57, 549.0, "M5"), m_dwarf(5));
  EXPECT_EQ(kind(5.49, 0.65, 71.3, "G2"), StarKind::most);
  // By the type alone: dwarfs, subgiants, giants beyond the table, a carbon star, no number.
  EXPECT_EQ(kind(7.5, 1.47, 0.0, "M2V"), m_dwarf(2));
  EXPECT_EQ(kind(7.5, 1.0, 0.0, "K1IV"), StarKind::most);
  EXPECT_EQ(kind(7.5, 1.0, 0.0, "K1IV-V"), StarKind::red_dwarf);
  EXPECT_EQ(kind(7.5, 1.4, 0.0, "M9III"), StarKind::m7_giant);
  EXPECT_EQ(kind(16.0, 1.9, 0.0, "M8Ve"), StarKind::m5_dwarf);
  EXPECT_EQ(kind(7.5, 2.5, 0.0, "C5"), StarKind::most);
  EXPECT_EQ(kind(7.5, 1.6, 0.0, "M"), StarKind::most);
  // Beside what a catalogue did not say.
  StarCatalogue c;
  ASSERT_EQ(append_star(c, {.spectral_type = "M4III"}), nullptr);
  EXPECT_EQ(c.flags[0] & 15, star_has_no_colour | star_has_no_parallax | star_has_no_proper_motion);
  EXPECT_EQ(c.colour(0).kind, m_giant(4));
}

TEST(StarCatalogue, RefusesNonsense) {
  StarCatalogue c;
  EXPECT_NE(append_star(c, {.ra_rad = 7.0}), nullptr);
  EXPECT_NE(append_star(c, {.dec_rad = NAN}), nullptr);
  EXPECT_NE(append_star(c, {.v_mag = NAN}), nullptr);
  EXPECT_NE(append_star(c, {.bv = INFINITY}), nullptr);
  EXPECT_EQ(c.size(), 0u);
}

}  // namespace
}  // namespace dmise
