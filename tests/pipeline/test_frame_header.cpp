#include <erfa.h>

#include <algorithm>
#include <cmath>

#include "core/base/units.h"
#include "core/config/sensors/pointing_config.h"
#include "core/image/fits_cards.h"
#include "core/image/fits_file.h"
#include "tests/pipeline/harness.h"

// What a frame's FITS header says, read back from its bytes, against ERFA and closed forms.
namespace dmise {
namespace {

/// Itrs from Gcrs by ERFA at a time as the header writes it; UT1 is UTC, the pole lies at 0.
Rotation<Itrs, Gcrs> turned_at(const std::string& utc) {
  int year, month, day, hour, minute;
  double second;
  EXPECT_EQ(
      std::sscanf(utc.c_str(), "%d-%d-%dT%d:%d:%lf", &year, &month, &day, &hour, &minute, &second),
      6);
  double utc1, utc2, tai1, tai2, tt1, tt2, ut11, ut12;
  eraDtf2d("UTC", year, month, day, hour, minute, second, &utc1, &utc2);
  eraUtctai(utc1, utc2, &tai1, &tai2);
  eraTaitt(tai1, tai2, &tt1, &tt2);
  eraUtcut1(utc1, utc2, 0.0, &ut11, &ut12);
  double m[3][3];
  eraC2t06a(tt1, tt2, ut11, ut12, 0.0, 0.0, m);
  Rotation<Itrs, Gcrs> r;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t k = 0; k < 3; ++k) r.m[i][k] = m[i][k];
  return r;
}

struct Read {
  FrameHeader header;
  std::string bytes;
  CountImage counts;

  bool has(const std::string& key) const {
    const std::string card = key + std::string(8 - key.size(), ' ') + "= ";
    for (std::size_t at = 0; at + 80 <= bytes.size() && bytes.compare(at, 4, "END ") != 0; at += 80)
      if (bytes.compare(at, 10, card) == 0) return true;
    return false;
  }
};

Read read_back(test::Stage& stage, std::uint32_t number = 1) {
  const auto frame = stage.frame(number);
  const std::string bytes = encode_frame(frame.counts, frame.header);
  Frame back = decode_frame(bytes, "frame.fits");
  return {back.header, bytes, std::move(back.counts)};
}

const std::string camera =
    "{name: 'Ann''s eye', optics: {columns: 64, rows: 48, pixel_pitch_m: 1.0e-5,"
    " focal_length_m: 0.5, aperture_m: 0.2}, detector: {full_well_e: 30000, gain_e_per_dn: 1.5,"
    " bias_dn: 700, adc_bits: 16, read_noise_e: 3}, band: {name: V, centre_m: 0.55e-6, width_m:"
    " 0.1e-6}}";

std::string scenario(const std::string& place, const std::string& pointing,
                     const std::string& more = "", double exposure_s = 8.0) {
  return "simulation: {start: 2018-01-21T00:15:00Z, duration_s: 20, tick_s: 5}\n"
         "objects:\n"
         "  - name: platform\n"
         "    attitude: nadir\n"
         "    motion: {two_body: {semi_major_axis_m: 7178137, eccentricity: 0, inclination_deg:"
         " 98.6, raan_deg: 0, true_anomaly_deg: 0}}\n"
         "  - name: \"d\xC3\xA9"
         "bris of a name that is fifty-eight or more characters 'long'\"\n"
         "    motion: {fixed: {latitude_deg: 30, longitude_deg: -80, height_m: 2000000}}\n"
         "sensors:\n  - {name: eye, " +
         place + ", camera: " + camera + ", pointing: " + pointing +
         ", exposure_s: " + std::to_string(exposure_s) + ", cadence_s: 10, first_exposure_s: 1.25" +
         more + "}\n";
}

const std::string atlanta = "site: atlanta", orbit = "platform: platform";

// Reference: ERFA eraC2t06a. A camera that stands on the ground keeps its attitude to it.
TEST(FrameHeader, FromQbegToQendACameraOnTheGroundTurnsWithTheEarth) {
  test::Stage stage(scenario(atlanta, "{azimuth_deg: 120, elevation_deg: 50}"));
  const FrameHeader h = read_back(stage).header;
  const std::string times[] = {h.start_utc, h.middle_utc, h.end_utc};
  const auto attitude = [&](std::size_t k) {
    return rotation_of<CameraFrame, Gcrs>(h.camera_from_gcrs[k]) * turned_at(times[k]).inverse();
  };
  const auto middle = attitude(1);
  for (const std::size_t k : {0u, 2u})
    for (const Vec<CameraFrame> axis : {Vec<CameraFrame>{0, 0, 1}, Vec<CameraFrame>{0, -1, 0}})
      EXPECT_LT(angle_rad(attitude(k).inverse() * axis, middle.inverse() * axis), 0.05 * arcsec);
  // East of the meridian stars rise: the boresight's right ascension grows by the Earth's turning.
  const auto boresight = [&](std::size_t k) {
    return rotation_of<CameraFrame, Gcrs>(h.camera_from_gcrs[k]).inverse() *
           Vec<CameraFrame>{0, 0, 1};
  };
  const double grows = to_spherical(boresight(2))[0] - to_spherical(boresight(0))[0];
  EXPECT_NEAR(grows, 7.292115e-5 * 8.0, 2e-6);
  EXPECT_EQ(h.mount, "fixed");
}

// Reference: omega x r about the celestial intermediate pole, whose direction is ERFA's.
TEST(FrameHeader, SenvelOfASiteIsOmegaCrossR) {
  test::Stage stage(scenario(atlanta, "zenith"));
  const FrameHeader h = read_back(stage).header;
  const Vec<Gcrs> pole = turned_at(h.middle_utc).inverse() * Vec<Itrs>{0, 0, 1};
  const Vec<Gcrs> expected = cross(pole, h.sensor_position_m) * 7.292115e-5;
  EXPECT_GT(norm(expected), 380.0);
  EXPECT_LT(norm(h.sensor_velocity_m_per_s - expected), 1e-3);
}

// Reference: uniform motion on a circle, (gm / a)^(1/2) along h x r.
TEST(FrameHeader, SenvelOfAPlatformIsThatOfItsCircle) {
  test::Stage stage(scenario(orbit, "zenith"));
  const FrameHeader h = read_back(stage).header;
  const double i = 98.6 * deg;
  const Vec<Gcrs> normal{0, -std::sin(i), std::cos(i)};
  const Vec<Gcrs> expected =
      cross(normal, unit(h.sensor_position_m)) * std::sqrt(3.986004418e14 / 7178137.0);
  EXPECT_LT(norm(h.sensor_velocity_m_per_s - expected), 0.01);
}

/// A sky that fills every well.
const std::string bright =
    ", sky: 2.0, effects: {photon_noise: off, read_noise: off, dark_current: off}";

TEST(FrameHeader, SaturateIsTheHighestCountWhereTheWellIsFull) {
  test::Stage stage(scenario(atlanta, "zenith", bright));
  const Read frame = read_back(stage);
  EXPECT_NEAR(frame.header.saturation_dn, 30000.0 / 1.5 + 700.0, 1e-6);
  const auto most = *std::max_element(frame.counts.pixels.begin(), frame.counts.pixels.end());
  EXPECT_NEAR(double(most), frame.header.saturation_dn, 0.5);
}

TEST(FrameHeader, SaturateIsTheHighestCountWhereTheAdcEnds) {
  std::string yaml = scenario(atlanta, "zenith", bright);
  yaml.replace(yaml.find("adc_bits: 16"), 12, "adc_bits: 14");
  test::Stage stage(yaml);
  const Read frame = read_back(stage);
  EXPECT_EQ(frame.header.saturation_dn, 16383.0);
  EXPECT_EQ(*std::max_element(frame.counts.pixels.begin(), frame.counts.pixels.end()), 16383);
}

TEST(FrameHeader, MountSaysHowTheCameraIsCarried) {
  for (const auto& [pointing, mount] : std::initializer_list<std::pair<const char*, const char*>>{
           {"{azimuth_deg: 1, elevation_deg: 50, azimuth_rate_deg_per_s: 0.1}", "moving"},
           {"{azimuth_deg: 1, elevation_deg: 50}", "fixed"},
           {"{ra_deg: 1, dec_deg: 50}", "sidereal"},
           {"{ra_deg: 1, dec_deg: 50, ra_rate_deg_per_s: 0.01}", "moving"},
           {"{scan: {ra_deg: 1, dec_deg: 50, axis: [0, 0, 1], rate_deg_per_s: 0.1}}", "moving"},
           {"{target: \"990000002\"}", "target"},
           {"{target: \"990000002\", tracking: sidereal}", "sidereal"}}) {
    test::Stage stage(scenario(atlanta, pointing));
    EXPECT_EQ(read_back(stage).header.mount, mount) << pointing;
  }
}

// Reference: ERFA eraAtoc13, the ICRS place of an observed azimuth and zenith distance; Kasten and
// Young 1989 for the airmass.
TEST(FrameHeader, RaDecAndAirmassAreThoseOfTheAzimuthAndElevationOfTheCentre) {
  for (const double elevation_deg : {20.0, 46.0, 80.0}) {
    test::Stage stage(scenario(
        atlanta, "{azimuth_deg: 200, elevation_deg: " + std::to_string(elevation_deg) + "}",
        ", weather: {pressure_hpa: 980, temperature_c: 8, humidity: 0.3}"));
    const Observation o = read_back(stage).header.observation;
    double utc1, utc2, ra, dec;
    eraDtf2d("UTC", 2018, 1, 21, 0, 15, 5.25, &utc1, &utc2);
    eraAtoc13("A", 200 * deg, (90 - elevation_deg) * deg, utc1, utc2, 0.0, -84.398 * deg,
              33.777 * deg, 300.0, 0.0, 0.0, 980.0, 8.0, 0.3, 0.55, &ra, &dec);
    ASSERT_TRUE(o.ra_rad && o.dec_rad && o.airmass);
    EXPECT_LT(angle_rad(from_spherical<Gcrs>(*o.ra_rad, *o.dec_rad), from_spherical<Gcrs>(ra, dec)),
              0.3 * arcsec)
        << elevation_deg;
    EXPECT_NEAR(
        *o.airmass,
        1 / (std::sin(elevation_deg * deg) + 0.50572 * std::pow(elevation_deg + 6.07995, -1.6364)),
        1e-6);
  }
}

TEST(FrameHeader, MjdObsIsTheStartInUtc) {
  test::Stage stage(scenario(atlanta, "zenith"));
  const Observation o = read_back(stage).header.observation;
  ASSERT_TRUE(o.start_mjd);
  EXPECT_NEAR(*o.start_mjd, 58139.0 + (15 * 60 + 1.25) / 86400.0, 1e-9);
}

/// Altitude of a place in ICRS over Atlanta by ERFA eraAtco13, without air.
double altitude_of(double ra, double dec) {
  double utc1, utc2, azimuth, zenith, hour, dec_o, ra_o, origins;
  eraDtf2d("UTC", 2018, 1, 21, 0, 15, 5.25, &utc1, &utc2);
  eraAtco13(ra, dec, 0, 0, 0, 0, utc1, utc2, 0.0, -84.398 * deg, 33.777 * deg, 300.0, 0.0, 0.0, 0.0,
            0.0, 0.0, 0.55, &azimuth, &zenith, &hour, &dec_o, &ra_o, &origins);
  return pi / 2 - zenith;
}

// Reference: astropy 5.2.1 get_body("sun") and ("moon"), builtin ephemeris, geocentric in GCRS ...
TEST(FrameHeader, SunaltAndMoonaltAreThoseOfErfa) {
  test::Stage stage(scenario(atlanta, "zenith"));
  const FrameHeader h = read_back(stage).header;
  ASSERT_TRUE(h.observation.sun_altitude_rad && h.observation.moon_altitude_rad);
  double utc1, utc2, tai1, tai2, tt1, tt2, moon[2][3], helio[2][3], bary[2][3];
  eraDtf2d("UTC", 2018, 1, 21, 0, 15, 5.25, &utc1, &utc2);
  eraUtctai(utc1, utc2, &tai1, &tai2);
  eraTaitt(tai1, tai2, &tt1, &tt2);
  eraEpv00(tt1, tt2, helio, bary);
  // Astrometric place of the Sun: aberration comes with eraAtco13; its light time moves it by mas.
  const auto sun = to_spherical(Vec<Gcrs>{-helio[0][0], -helio[0][1], -helio[0][2]});
  const double parallax = 8.794 * arcsec;
  const double sun_altitude = altitude_of(sun[0], sun[1]);
  EXPECT_NEAR(*h.observation.sun_altitude_rad, sun_altitude - parallax * std::cos(sun_altitude),
              1 * arcsec);
  eraMoon98(tt1, tt2, moon);
  const auto& site = h.sensor_position_m;
  constexpr double au = 149597870700.0;
  const Vec<Gcrs> line = Vec<Gcrs>{moon[0][0], moon[0][1], moon[0][2]} * au - site;
  const Vec<Gcrs> up =
      turned_at(h.middle_utc).inverse() *
      Vec<Itrs>{std::cos(33.777 * deg) * std::cos(-84.398 * deg),
                std::cos(33.777 * deg) * std::sin(-84.398 * deg), std::sin(33.777 * deg)};
  EXPECT_NEAR(*h.observation.moon_altitude_rad, pi / 2 - angle_rad(line, up), 1 * arcsec);
}

TEST(FrameHeader, WhatMakesNoSenseIsAbsent) {
  test::Stage space(scenario(orbit, "zenith"));
  const Read above = read_back(space);
  for (const char* key : {"AIRMASS", "SUNALT", "MOONALT", "OBJECT"}) EXPECT_FALSE(above.has(key));
  for (const char* key : {"RA", "DEC", "MJD-OBS", "TELESCOP", "BUNIT"}) EXPECT_TRUE(above.has(key));
  test::Stage down(scenario(atlanta, "{azimuth_deg: 0, elevation_deg: -20}"));
  EXPECT_FALSE(read_back(down).has("AIRMASS"));
  EXPECT_TRUE(read_back(down).has("SUNALT"));
}

TEST(FrameHeader, NamesThatAHeaderCannotHoldAreShownAsFarAsItCan) {
  test::Stage stage(scenario(atlanta, "{target: \"990000002\"}"));
  const Observation o = read_back(stage).header.observation;
  EXPECT_EQ(o.object, "d?bris of a name that is fifty-eight or more characters 'lo");
  EXPECT_EQ(o.telescope, "Ann's eye");
}

// A sensor's name may have 64 characters; a filter's may be anything.
TEST(FrameHeader, TheLongestNameOfASensorAndAnyNameOfAFilterAreWritten) {
  const std::string name(64, 'x');
  std::string yaml = scenario(atlanta, "zenith");
  yaml.replace(yaml.find("name: eye,"), 9, "name: " + name);
  yaml.replace(yaml.find("name: V,"), 7, "name: \"\xCE\xBB " + std::string(80, '\'') + "\"");
  test::Stage stage(yaml);
  const FrameHeader h = read_back(stage).header;
  EXPECT_EQ(h.sensor, name);
  EXPECT_EQ(h.band.name, "? " + std::string(29, '\''));
}

// A card that ends at its last column may have lost the end of its comment.
TEST(FrameHeader, CommentsAreWhole) {
  for (const std::string& place : {atlanta, orbit}) {
    test::Stage stage(scenario(place, "{target: \"990000002\"}"));
    const std::string bytes = read_back(stage).bytes;
    for (std::size_t at = 0; bytes.compare(at, 4, "END ") != 0; at += 80) {
      const std::string card = bytes.substr(at, 80);
      const std::size_t slash = card.rfind(" / ");
      EXPECT_TRUE(slash == std::string::npos || card.back() == ' ') << card;
    }
  }
}

// What others write in these keywords is taken where it is meant as ours, else left.
TEST(FrameHeader, KeywordsOfFilesFromElsewhereMayBeAnything) {
  test::Stage stage(scenario(atlanta, "{target: \"990000002\"}"));
  const Read frame = read_back(stage);
  for (const char* key :
       {"OBJECT", "TELESCOP", "MJD-OBS", "RA", "DEC", "AIRMASS", "SUNALT", "MOONALT", "BUNIT"})
    for (const std::string value :
         {"'12:34:56.7'", "'it''s'", "T", "nan", "1e999", "-", "''", "(1, 2)", "", "1.5D2"}) {
      std::string bytes = frame.bytes;
      const std::string card = key + std::string(8 - std::string(key).size(), ' ') + "= ";
      const std::size_t at = bytes.find(card);
      ASSERT_NE(at, std::string::npos) << key;
      std::string other = card + value;
      other.resize(80, ' ');
      bytes.replace(at, 80, other);
      const auto read = decode_frame(bytes, "frame.fits");
      EXPECT_EQ(as_in_file(read.header), read.header) << key << " = " << value;
      EXPECT_EQ(read.counts.pixels, frame.counts.pixels);
    }
}

}  // namespace
}  // namespace dmise
