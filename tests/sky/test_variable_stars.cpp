#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "core/base/units.h"
#include "core/sky/places/sun_moon.h"
#include "core/sky/variables/variable_stars.h"
#include "core/time/clock.h"
#include "core/time/iso8601.h"
#include "tests/sky/gcvs_rows.h"
#include "tests/support/config_error.h"

namespace dmise {
namespace {

StarRecord star_at(double ra_deg, double dec_deg, double v_mag) {
  return {.ra_rad = ra_deg * deg, .dec_rad = dec_deg * deg, .v_mag = v_mag};
}

StarMap map_of(const std::vector<StarRecord>& stars) {
  StarCatalogue catalogue;
  std::uint32_t id = 0;
  for (StarRecord star : stars) {
    star.id = ++id;
    EXPECT_EQ(append_star(catalogue, star), nullptr);
  }
  return star_map_of(std::move(catalogue));
}

/// A catalogue of the stars of a file, at their mean magnitudes.
StarMap map_of(const VariableReading& reading) {
  std::vector<StarRecord> stars;
  for (const VariableRecord& record : reading.stars)
    stars.push_back({.ra_rad = record.ra_rad,
                     .dec_rad = record.dec_rad,
                     .v_mag = *record.brightest_mag + 0.5 * *record.depth_mag});
  return map_of(stars);
}

const VariableStars::Star& named(const VariableStars& stars, const std::string& name) {
  for (const auto& star : stars.stars())
    if (star.name == name) return star;
  throw Error("no star " + name);
}

VariableTime at_earth(const std::string& utc) {
  const Tt tt = Clock(parse_utc(utc)).tt({});
  return variable_time(tt, -1.0 * solar_system(tt).sun_m);
}

struct Row {
  const char* name;
  const char* utc;
  double hjd, v_mag;
};
// Reference: tests/reference/variable_stars.py, astropy's heliocentric dates and curves of its own.
const Row rows[] = {
    {"bet Per", "2018-01-21T03:00:30Z", 2458139.627601, 2.1200},
    {"bet Per", "2018-04-02T09:17:00Z", 2458210.882956, 2.1200},
    {"bet Per", "2018-08-15T21:44:10Z", 2458346.405350, 2.4257},
    {"bet Per", "2018-11-30T16:05:00Z", 2458453.175289, 2.1200},
    {"W UMa", "2018-01-21T03:00:30Z", 2458139.629710, 7.8327},
    {"W UMa", "2018-04-02T09:17:00Z", 2458210.888660, 8.0443},
    {"W UMa", "2018-08-15T21:44:10Z", 2458346.401327, 8.0651},
    {"W UMa", "2018-11-30T16:05:00Z", 2458453.172418, 7.9746},
    {"bet Lyr", "2018-01-21T03:00:30Z", 2458139.622236, 3.5697},
    {"bet Lyr", "2018-04-02T09:17:00Z", 2458210.886437, 3.8769},
    {"bet Lyr", "2018-08-15T21:44:10Z", 2458346.408388, 3.6257},
    {"bet Lyr", "2018-11-30T16:05:00Z", 2458453.167725, 3.2703},
    {"del Cep", "2018-01-21T03:00:30Z", 2458139.624691, 4.2630},
    {"del Cep", "2018-04-02T09:17:00Z", 2458210.883892, 3.6836},
    {"del Cep", "2018-08-15T21:44:10Z", 2458346.407378, 3.7883},
    {"del Cep", "2018-11-30T16:05:00Z", 2458453.171974, 3.5691},
    {"RR Lyr", "2018-01-21T03:00:30Z", 2458139.622827, 8.0353},
    {"RR Lyr", "2018-04-02T09:17:00Z", 2458210.885738, 7.7425},
    {"RR Lyr", "2018-08-15T21:44:10Z", 2458346.408180, 7.8604},
    {"RR Lyr", "2018-11-30T16:05:00Z", 2458453.168819, 8.0490},
    {"ST CVn", "2018-01-21T03:00:30Z", 2458139.626604, 11.0546},
    {"ST CVn", "2018-04-02T09:17:00Z", 2458210.891304, 11.5926},
    {"ST CVn", "2018-08-15T21:44:10Z", 2458346.402834, 11.4128},
    {"ST CVn", "2018-11-30T16:05:00Z", 2458453.167519, 11.2834},
    {"omi Cet", "2018-01-21T03:00:30Z", 2458139.625419, 2.2308},
    {"omi Cet", "2018-04-02T09:17:00Z", 2458210.881563, 5.4693},
    {"omi Cet", "2018-08-15T21:44:10Z", 2458346.407708, 9.4430},
    {"omi Cet", "2018-11-30T16:05:00Z", 2458453.174535, 2.0069},
    {"T Cen", "2018-01-21T03:00:30Z", 2458139.624856, 7.2505},
    {"T Cen", "2018-04-02T09:17:00Z", 2458210.891724, 8.9793},
    {"T Cen", "2018-08-15T21:44:10Z", 2458346.404110, 5.5811},
    {"T Cen", "2018-11-30T16:05:00Z", 2458453.165645, 6.9117},
};

TEST(VariableStars, HaveTheMagnitudesOfTheirElements) {
  const VariableReading reading = parse_gcvs(test::gcvs_rows, "gcvs");
  const StarMap map = map_of(reading);
  const VariableStars stars(map, reading);
  for (const Row& row : rows) {
    const auto& star = named(stars, row.name);
    const Vec<Gcrs> direction = map.index.direction[star.place];
    const VariableTime time = at_earth(row.utc);
    EXPECT_NEAR(time.heliocentric_jd(direction), row.hjd, 2e-6) << row.name << row.utc;  // 0.2 s
    EXPECT_NEAR(stars.v_mag(star.place, 99.0, time, direction), row.v_mag, 5e-4)
        << row.name << row.utc;
  }
}

// Reference: the AAVSO's brightest V of delta Cephei in 2025, JD 2460851.3958 (arXiv:2606.29543). A
// thousand periods after the catalogue's epoch its elements give it to 0.02 of a period.
TEST(VariableStars, DeltaCepheiIsBrightestWhenItWasSeenToBe) {
  const VariableReading reading = parse_gcvs(test::gcvs_rows, "gcvs");
  const VariableStars stars(map_of(reading), reading);
  const double phase = named(stars, "del Cep").curve.phase(2460851.3958);
  EXPECT_LT(std::min(phase, 1.0 - phase), 0.02);
  EXPECT_LT(named(stars, "del Cep").curve.v_mag(2460851.3958), 3.48 + 0.05);
}

TEST(VariableStars, WithoutAnEpochHaveTheCataloguesMagnitude) {
  const VariableReading reading = parse_gcvs(test::gcvs_rows, "gcvs");
  const StarMap map = map_of(reading);
  const VariableStars stars(map, reading);
  const auto& betelgeuse = named(stars, "alf Ori");
  EXPECT_FALSE(betelgeuse.varies());
  EXPECT_EQ(stars.v_mag(betelgeuse.place, 0.5, at_earth("2018-01-21T03:00:30Z"), {1, 0, 0}), 0.5);
  // Detection still knows its range.
  EXPECT_EQ(betelgeuse.brightest_v_mag, 0.0);
  EXPECT_NEAR(betelgeuse.faintest_v_mag, 1.3, 1e-12);
}

VariableRecord record_at(double ra_deg, double dec_deg, double brightest_mag, double depth_mag) {
  return {.name = "X",
          .type = "M",
          .ra_rad = ra_deg * deg,
          .dec_rad = dec_deg * deg,
          .brightest_mag = brightest_mag,
          .depth_mag = depth_mag,
          .second_depth_mag = {},
          .band = "V",
          .epoch_hjd = 2450000.0,
          .period_d = 100.0,
          .share_of_period = 0.5};
}

VariableReading reading_of(std::vector<VariableRecord> records) {
  VariableReading reading;
  reading.stars = std::move(records);
  return reading;
}

TEST(VariableStars, AreTheNearestStarsThatMayBeSoBright) {
  const double second = 1.0 / 3600.0;
  // Two stars 3 arcsec apart; the variable is 1 arcsec from the second.
  const StarMap map = map_of(
      {star_at(10, 0, 8), star_at(10 + 3 * second, 0, 8.5), star_at(20, 0, 14), star_at(30, 0, 8)});
  const auto id_of = [&](const VariableStars& stars, std::size_t i) {
    return map.stars.id[stars.stars()[i].place];
  };
  const VariableStars near(map, reading_of({record_at(10 + 2 * second, 0, 7, 2)}));
  ASSERT_EQ(near.stars().size(), 1u);
  EXPECT_EQ(id_of(near, 0), 2u);
  // Two records: each star is one of them.
  const VariableStars two(map, reading_of({record_at(10 + 2 * second, 0, 7, 2),
                                           record_at(10 + 2.5 * second, 0, 7, 2)}));
  EXPECT_EQ(two.stars().size(), 2u);
  EXPECT_NE(id_of(two, 0), id_of(two, 1));
  // Nothing: too faint a star, or too far away.
  EXPECT_TRUE(VariableStars(map, reading_of({record_at(20, 0, 7, 2)})).stars().empty());
  EXPECT_TRUE(
      VariableStars(map, reading_of({record_at(30 + 6 * second, 0, 7, 2)})).stars().empty());
  EXPECT_EQ(VariableStars(map, reading_of({record_at(30 + 4 * second, 0, 7, 2)})).stars().size(),
            1u);
}

// Barnard's star moves by 10 arcsec a year: where it was at J2000.0 counts.
TEST(VariableStars, AreLookedForWhereTheStarWas) {
  StarCatalogue catalogue;
  catalogue.epoch_jyear = 2020.0;
  append_star(catalogue, {.id = 1,
                          .ra_rad = 10 * deg,
                          .dec_rad = 0.0,
                          .pm_ra_cosdec_rad_per_yr = 0.0,
                          .pm_dec_rad_per_yr = 10 * arcsec,
                          .v_mag = 8});
  const StarMap map = star_map_of(std::move(catalogue));
  EXPECT_EQ(VariableStars(map, reading_of({record_at(10, -200.0 / 3600, 7, 2)})).stars().size(),
            1u);
  EXPECT_TRUE(VariableStars(map, reading_of({record_at(10, 0, 7, 2)})).stars().empty());
}

// The catalogue's magnitude is the mean if the record is of another band than V.
TEST(VariableStars, OfAnotherBandVaryAboutTheCataloguesMagnitude) {
  const StarMap map = map_of({star_at(10, 0, 8)});
  VariableRecord record = record_at(10, 0, 7.5, 2);
  record.band = "p";
  const VariableStars stars(map, reading_of({record}));
  ASSERT_EQ(stars.stars().size(), 1u);
  EXPECT_NEAR(stars.stars()[0].brightest_v_mag, 7.0, 1e-9);
  EXPECT_NEAR(stars.stars()[0].mean_v_mag, 8.0, 1e-9);
  EXPECT_NEAR(stars.stars()[0].faintest_v_mag, 9.0, 1e-9);
}

// A Mira that the catalogue has at its minimum is found by the brightest that it may be.
TEST(VariableStars, AreFoundByTheirBrightest) {
  auto map = std::make_shared<StarMap>(map_of({star_at(10, 0, 11), star_at(10.1, 0, 6)}));
  map->variables =
      std::make_shared<const VariableStars>(*map, reading_of({record_at(10, 0, 4, 7)}));
  const Vec<Gcrs> axis = from_spherical<Gcrs>(10 * deg, 0.0);
  std::vector<std::uint32_t> found;
  query_cone(*map, axis, 1 * deg, 9.5, found);
  EXPECT_EQ(found.size(), 1u);
  found.clear();
  query_brightest(*map, axis, 1 * deg, 9.5, found);
  EXPECT_EQ(found, (std::vector<std::uint32_t>{0, 1}));
  found.clear();
  query_brightest(*map, from_spherical<Gcrs>(12 * deg, 0.0), 1 * deg, 9.5, found);
  EXPECT_TRUE(found.empty());
}

TEST(VariableStars, OfABadFileAreOneLine) {
  const std::string path = (std::filesystem::path(testing::TempDir()) / "bad-gcvs.txt").string();
  std::ofstream(path) << "not a catalogue\n";
  const auto map = std::make_shared<const StarMap>(map_of({star_at(10, 0, 8)}));
  EXPECT_TRUE(test::config_error_of([&] {
                with_variable_stars(map, path);
              }).starts_with(path + ":1:1: no variable star in it"));
  std::filesystem::remove(path);
}

}  // namespace
}  // namespace dmise
