#include <gtest/gtest.h>

#include <cstdio>
#include <numeric>
#include <vector>

#include "core/sky/places/apparent.h"
#include "core/sky/places/place_effects.h"
#include "core/time/iso8601.h"
#include "tests/support/data.h"
#include "tests/support/directions.h"

namespace dmise {
namespace {

struct Row {
  double jd1, jd2;
  double ra_rad, dec_rad, pm_ra, pm_dec, parallax, radial_velocity;
  Vec<Gcrs> position_m, velocity_m_per_s, direction;

  StarPlace star() const {
    return {ra_rad, dec_rad, pm_ra, pm_dec, parallax, radial_velocity, 2000.0};
  }
  Observer observer() const {
    const Tt tt{jd1, jd2};
    return space_observer(position_m, velocity_m_per_s, tt, solar_system(tt));
  }
};

EffectSet all_but(std::initializer_list<EffectFacts> off) {
  EffectSet effects;
  for (const EffectFacts& e : off) effects.set(e, false);
  return effects;
}

// Reference: astropy's ICRS to GCRS at the observer, tests/reference/apparent_stars.py 64 1.
TEST(ApparentStars, AgreeWithAstropyToFiveMilliarcseconds) {
  const Row rows[] = {
#include "tests/sky/apparent_stars_reference.inc"
  };
  for (const Row& row : rows)
    EXPECT_LT(angle_rad(ApparentPlaces(row.observer(), {}).star(row.star()), row.direction),
              1 * mas)
        << row.ra_rad / deg << " " << row.dec_rad / deg;
}

// The script of these rows is run now for a thousand stars.
TEST(ApparentStars, AThousandAgreeWithAstropyAtRunTime) {
  const std::string python = "/usr/bin/python3";
  DMISE_NEEDS_FILE(python);
  FILE* pipe = popen((python + " -W ignore " DMISE_SOURCE_DIR
                               "/tests/reference/apparent_stars.py 1014 2 2>/dev/null")
                         .c_str(),
                     "r");
  ASSERT_TRUE(pipe);
  int count = 0;
  double worst = 0.0;
  double v[17];
  for (;;) {
    int read = 0;
    while (read < 17 && std::fscanf(pipe, read ? ",%lf" : "%lf", &v[read]) == 1) ++read;
    if (read < 17) break;
    const Row row{v[0],
                  v[1],
                  v[2],
                  v[3],
                  v[4],
                  v[5],
                  v[6],
                  v[7],
                  {v[8], v[9], v[10]},
                  {v[11], v[12], v[13]},
                  {v[14], v[15], v[16]}};
    const Vec<Gcrs> p = ApparentPlaces(row.observer(), {}).star(row.star());
    worst = std::max(worst, angle_rad(p, row.direction));
    ++count;
  }
  const int status = pclose(pipe);
  if (count == 0) DMISE_SKIP() << "python3-astropy is not there (status " << status << ")";
  EXPECT_GE(count, 1000);
  EXPECT_LT(worst, 1 * mas);
  RecordProperty("worst_uas", static_cast<int>(worst / mas * 1000));
}

Observer atlanta(const char* utc) {
  const Clock clock(parse_utc(utc));
  return ground_observer({33.777, -84.398, 300.0}, earth_orientation(clock, {}), {}, clock.tt({}),
                         solar_system(clock.tt({})), Refraction(standard_weather(300.0)));
}

// Reference: astropy's ICRS to AltAz, tests/reference/apparent_altaz.py: the whole way from a
// catalogue place to a site's horizon. With air only down to 15 deg, where astropy's model is ours
// too.
TEST(ApparentStars, StandOverASitesHorizonWhereAstropySees) {
  const struct {
    const char* utc;
    double ut1_minus_utc_s, pole_x_arcsec, pole_y_arcsec, ra_deg, dec_deg;
    double azimuth_deg, elevation_deg, air_azimuth_deg, air_elevation_deg;
  } rows[] = {
#include "tests/sky/apparent_altaz_reference.inc"
  };
  const Site site{33.777, -84.398, 300.0};
  const Refraction refraction(Weather{800.0, 5.0, 0.3}, 0.7);
  for (const auto& row : rows) {
    const Clock clock(parse_utc(row.utc));
    Ut1 ut1 = clock.ut1({});
    ut1.jd2 += row.ut1_minus_utc_s / day_s;
    const EarthOrientation earth = earth_orientation(
        {}, clock.tt({}), ut1, row.pole_x_arcsec * arcsec, row.pole_y_arcsec * arcsec);
    const Observer here =
        ground_observer(site, earth, {}, clock.tt({}), solar_system(clock.tt({})), refraction);
    const StarPlace star{row.ra_deg * deg, row.dec_deg * deg};
    const auto seen = [&](const EffectSet& effects) {
      return enu_from_itrs(site) *
             (earth.itrs_from_gcrs({}) * ApparentPlaces(here, effects).star(star));
    };
    EXPECT_LT(angle_rad(seen(all_but({AtmosphericRefraction::facts})),
                        from_horizontal({row.azimuth_deg * deg, row.elevation_deg * deg})),
              2 * mas)
        << row.utc;
    if (row.elevation_deg > 15) {
      EXPECT_LT(angle_rad(seen({}), from_horizontal(
                                        {row.air_azimuth_deg * deg, row.air_elevation_deg * deg})),
                5 * mas)
          << row.utc;
    }
  }
}

// A thousand random stars, the pole among them, from catalogue to refracted place over a horizon.
TEST(ApparentStars, AThousandAboveTwentyDegreesAgreeWithAstropyThroughTheAir) {
  const std::string python = "/usr/bin/python3";
  DMISE_NEEDS_FILE(python);
  FILE* pipe = popen((python + " -W ignore " DMISE_SOURCE_DIR
                               "/tests/reference/apparent_altaz.py 1000 3 2>/dev/null")
                         .c_str(),
                     "r");
  ASSERT_TRUE(pipe);
  const Site site{33.777, -84.398, 300.0};
  const Refraction refraction(Weather{800.0, 5.0, 0.3}, 0.7);
  int count = 0;
  double worst_air = 0.0, worst_plain = 0.0;
  char utc[64];
  double v[9];
  while (std::fscanf(pipe, "%63s", utc) == 1) {
    for (double& value : v) ASSERT_EQ(std::fscanf(pipe, "%lf", &value), 1);
    const Clock clock(parse_utc(utc));
    Ut1 ut1 = clock.ut1({});
    ut1.jd2 += v[0] / day_s;
    const EarthOrientation earth =
        earth_orientation({}, clock.tt({}), ut1, v[1] * arcsec, v[2] * arcsec);
    const Observer here =
        ground_observer(site, earth, {}, clock.tt({}), solar_system(clock.tt({})), refraction);
    const auto off = [&](const EffectSet& effects, double azimuth_deg, double elevation_deg) {
      const Vec<Enu> seen =
          enu_from_itrs(site) *
          (earth.itrs_from_gcrs({}) * ApparentPlaces(here, effects).star({v[3] * deg, v[4] * deg}));
      return angle_rad(seen, from_horizontal({azimuth_deg * deg, elevation_deg * deg}));
    };
    worst_plain = std::max(worst_plain, off(all_but({AtmosphericRefraction::facts}), v[5], v[6]));
    worst_air = std::max(worst_air, off({}, v[7], v[8]));
    ++count;
  }
  const int status = pclose(pipe);
  if (count == 0) DMISE_SKIP() << "python3-astropy is not there (status " << status << ")";
  EXPECT_EQ(count, 1000);
  EXPECT_LT(worst_plain, 5 * mas);
  EXPECT_LT(worst_air, 0.5 * arcsec);
  RecordProperty("worst_plain_uas", static_cast<int>(worst_plain / mas * 1000));
  RecordProperty("worst_air_uas", static_cast<int>(worst_air / mas * 1000));
}

// Sizes as in any textbook on positional astronomy.
TEST(ApparentStars, EachCorrectionHasItsSizeAndItsSwitch) {
  const Observer here = atlanta("2018-01-20T23:40:00Z");
  const StarPlace barnard{269.452079 * deg, 4.693391 * deg, -0.79858 * arcsec, 10.32812 * arcsec,
                          0.54831 * arcsec};
  const auto moved_by = [&](const EffectFacts& effect, const StarPlace& star) {
    return angle_rad(ApparentPlaces(here, {}).star(star),
                     ApparentPlaces(here, all_but({effect})).star(star));
  };
  EXPECT_NEAR(moved_by(ProperMotion::facts, barnard), 18.055 * 10.36 * arcsec, 0.5 * arcsec);
  EXPECT_LT(moved_by(Parallax::facts, barnard), 0.56 * arcsec);
  EXPECT_GT(moved_by(Parallax::facts, barnard), 0.1 * arcsec);

  const auto largest = [&](const EffectFacts& effect) {
    double most = 0.0;
    for (int i = 0; i < 400; ++i) {
      // Stars at 30 deg and more over the horizon.
      const Vec<Gcrs> p = unit(here.air->zenith +
                               from_spherical<Gcrs>(0.7 * i, std::asin(std::sin(1.1 * i))) * 0.86);
      const auto [ra, dec] = to_spherical(p);
      most = std::max(most, moved_by(effect, {ra, dec}));
    }
    return most;
  };
  EXPECT_NEAR(largest(AnnualAberration::facts), 20.8 * arcsec, 0.4 * arcsec);
  EXPECT_NEAR(largest(DiurnalAberration::facts), 0.32 * std::cos(33.777 * deg) * arcsec,
              0.01 * arcsec);
  EXPECT_GT(largest(LightDeflection::facts), 3 * mas);
  EXPECT_LT(largest(LightDeflection::facts), 30 * mas);
  EXPECT_GT(largest(AtmosphericRefraction::facts), 90 * arcsec);
  EXPECT_EQ(largest(LightTime::facts), 0.0);
}

TEST(ApparentStars, AllSwitchedOffIsTheCataloguePlace) {
  const EffectSet none =
      all_but({ProperMotion::facts, Parallax::facts, LightDeflection::facts,
               AnnualAberration::facts, DiurnalAberration::facts, AtmosphericRefraction::facts});
  const StarPlace star{1.0, 0.5, 1e-5, 1e-5, 1e-6};
  EXPECT_LT(angle_rad(ApparentPlaces(atlanta("2018-01-20T23:40:00Z"), none).star(star),
                      from_spherical<Gcrs>(1.0, 0.5)),
            1e-15);
}

TEST(ApparentStars, RefractionLiftsTowardsTheZenithAndNothingAtIt) {
  const Observer here = atlanta("2018-01-20T23:40:00Z");
  const ApparentPlaces with(here, {}), without(here, all_but({AtmosphericRefraction::facts}));
  for (double away = 0.0; away < 3.1; away += 0.01) {
    const Vec<Gcrs> side = unit(cross(here.air->zenith, {0.1, 0.2, 0.9}));
    const auto [ra, dec] = to_spherical(here.air->zenith * std::cos(away) + side * std::sin(away));
    const Vec<Gcrs> up = with.star({ra, dec}), straight = without.star({ra, dec});
    ASSERT_NEAR(norm(up), 1.0, 1e-14);
    const double z = angle_rad(straight, here.air->zenith);
    const double lift = z - angle_rad(up, here.air->zenith);
    ASSERT_GE(lift, -1e-12) << away;
    ASSERT_NEAR(angle_rad(up, straight), lift, 1e-12) << away;  // along the vertical
    if (z < 1.0) {
      ASSERT_NEAR(lift, 55.5 * arcsec * std::tan(z), 0.5 * arcsec);
    }
  }
}

TEST(ApparentStars, CrossThePoleAndTheTwentyFourHourLineWithoutAStep) {
  const ApparentPlaces places(atlanta("2018-01-20T23:40:00Z"), {});
  const double step = 1 * mas;
  const StarPlace moving{.pm_ra_cosdec_rad_per_yr = 3 * arcsec, .parallax_rad = 0.1 * arcsec};
  const auto at = [&](double ra, double dec) {
    StarPlace star = moving;
    star.ra_rad = ra;
    star.dec_rad = dec;
    return places.star(star);
  };
  for (int i = -5; i <= 5; ++i) {
    EXPECT_NEAR(angle_rad(at(2 * pi + i * step, 0.3), at(i * step, 0.3)), 0.0, 1e-14);
    EXPECT_NEAR(angle_rad(at(i * step, 0.3), at((i + 1) * step, 0.3)), step * std::cos(0.3),
                0.01 * mas);
  }
  // A star without proper motion, over the pole along a meridian.
  const auto still = [&](double north_of_pole) {
    return places.star(
        {.ra_rad = north_of_pole > 0 ? pi : 0.0, .dec_rad = pi / 2 - std::abs(north_of_pole)});
  };
  for (int i = -5; i < 5; ++i)
    EXPECT_NEAR(angle_rad(still(i * step), still((i + 1) * step)), step, 0.01 * mas);
}

TEST(ApparentStars, AStarAtThePoleMovesByItsProperMotion) {
  const Observer here = atlanta("2018-01-20T23:40:00Z");
  const ApparentPlaces places(here, all_but({AtmosphericRefraction::facts}));
  const StarPlace still{.ra_rad = 0.3, .dec_rad = pi / 2};
  StarPlace moving = still;
  moving.pm_ra_cosdec_rad_per_yr = 3 * arcsec;
  moving.pm_dec_rad_per_yr = 4 * arcsec;
  EXPECT_NEAR(angle_rad(places.star(still), places.star(moving)), 18.055 * 5 * arcsec,
              0.02 * arcsec);
}

TEST(ApparentStars, ABatchGivesTheSameAsOneByOne) {
  const ApparentPlaces places(atlanta("2018-01-20T23:40:00Z"), {});
  constexpr std::size_t n = 10000;
  std::vector<double> ra(n), dec(n), pm_ra(n, 1e-7), pm_dec(n, -1e-7), parallax(n, 1e-8);
  for (std::size_t i = 0; i < n; ++i) {
    ra[i] = std::fmod(0.37 * i, 2 * pi);
    dec[i] = std::asin(std::sin(0.11 * i));
  }
  std::vector<std::uint32_t> which(n);
  std::iota(which.rbegin(), which.rend(), 0u);
  std::vector<Vec<Gcrs>> directions(n);
  places.stars({2000.0, ra, dec, pm_ra, pm_dec, parallax, {}}, which, directions);
  for (std::size_t k = 0; k < n; ++k) {
    const std::size_t i = which[k];
    ASSERT_EQ(directions[k], places.star({ra[i], dec[i], 1e-7, -1e-7, 1e-8}));
  }
}

// With each of the effects that move stars and without, at the poles, too.
TEST(ApparentStars, ManyAstrometricPlacesAreThoseOfEachOnEveryInstructionSet) {
  constexpr std::size_t n = 2011;
  std::vector<double> ra(n), dec(n), pm_ra(n), pm_dec(n), parallax(n);
  std::vector<Vec<Gcrs>> from(n);
  for (std::size_t i = 0; i < n; ++i) {
    ra[i] = std::fmod(0.37 * double(i), 2 * pi);
    dec[i] = i < 8 ? (i % 2 ? 0.5 : -0.5) * pi : std::asin(std::sin(0.11 * double(i)));
    pm_ra[i] = 5e-5 * std::sin(0.3 * double(i)), pm_dec[i] = 5e-5 * std::cos(0.7 * double(i));
    parallax[i] = 1e-9 * double(i % 100);
    from[i] = from_spherical<Gcrs>(ra[i], dec[i]);
  }
  const StarColumns columns{1991.25, ra, dec, pm_ra, pm_dec, parallax, {}};
  std::vector<std::uint32_t> which(n);
  std::iota(which.rbegin(), which.rend(), 0u);
  for (const EffectSet& effects :
       {EffectSet(), all_but({ProperMotion::facts}), all_but({Parallax::facts}),
        all_but({ProperMotion::facts, Parallax::facts})}) {
    const ApparentPlaces places(atlanta("2018-01-20T23:40:00Z"), effects);
    std::vector<Vec<Gcrs>> many(n), other(n);
    places.astrometric(columns, which, from, many, SimdLevel::sse2);
    for (std::size_t k = 0; k < n; ++k) {
      const std::size_t i = which[k];
      const StarPlace star{ra[i], dec[i], pm_ra[i], pm_dec[i], parallax[i], 0.0, 1991.25};
      const Vec<Gcrs> one = places.astrometric(CataloguedStar(star, from[i]));
      ASSERT_LT(norm(many[k] - one), 2e-15) << i;
      ASSERT_LT(norm(many[k] - places.astrometric(CataloguedStar(star))), 1e-11) << i;
    }
    for (const SimdLevel level : {SimdLevel::avx2, SimdLevel::avx512}) {
      if (level > best_simd_level()) continue;
      places.astrometric(columns, which, from, other, level);
      EXPECT_EQ(other, many) << name(level);
    }
    places.astrometric(columns, {}, from, {});
  }
}

}  // namespace
}  // namespace dmise
