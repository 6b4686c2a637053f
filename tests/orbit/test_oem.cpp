#include "core/orbit/oem.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cstdio>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/orbit/motion.h"

namespace dmise {
namespace {

using testing::HasSubstr;

const TwoBodyState start =
    state_of({.periapsis_m = 7e6, .eccentricity = 0.1, .inclination_rad = 1});

std::string meta(const std::string& frame = "GCRF", const std::string& system = "TAI",
                 const std::string& more = "") {
  return "META_START\nOBJECT_NAME = INSPECTOR\nOBJECT_ID = 2026-001A\nCENTER_NAME = "
         "EARTH\nREF_FRAME = " +
         frame + "\nTIME_SYSTEM = " + system + "\n" + more + "META_STOP\n";
}
/// Metadata of another object.
std::string named(const std::string& name, const std::string& id) {
  return "META_START\nOBJECT_NAME = " + name + "\nOBJECT_ID = " + id +
         meta().substr(meta().find("\nCENTER"));
}
const std::string header =
    "CCSDS_OEM_VERS = 2.0\nCREATION_DATE = 2026-01-01T00:00:00\nORIGINATOR = T\n";

std::string line(const char* time, const TwoBodyState& s) {
  char text[400];
  std::snprintf(text, sizeof text, "%s %.12f %.12f %.12f %.15f %.15f %.15f\n", time,
                s.position_m.x / km, s.position_m.y / km, s.position_m.z / km,
                s.velocity_m_per_s.x / km, s.velocity_m_per_s.y / km, s.velocity_m_per_s.z / km);
  return text;
}

/// The two-body path from midnight on, a line each minute.
std::string lines(int first_minute, int last_minute) {
  std::string text;
  for (int m = first_minute; m <= last_minute; ++m) {
    char time[40];
    std::snprintf(time, sizeof time, "2026-01-01T00:%02d:00.000", m);
    text += line(time, propagate_two_body(start, 60.0 * m));
  }
  return text;
}

constexpr double midnight = 2461041.5;  // 2026-01-01
Tai at(double t_s) { return {midnight, t_s / 86400}; }
MotionState<Gcrs> gcrs(const Trajectory& t, double t_s) {
  return std::get<MotionState<Gcrs>>(state_at(t, at(t_s)));
}

TEST(Oem, HermiteOfDegree7FollowsAnOrbitToMicrometres) {
  const Trajectory t = parse_oem(header + meta() + lines(0, 20), "t.oem");
  for (double t_s = 0; t_s <= 1200; t_s += 7) {
    const TwoBodyState truth = propagate_two_body(start, t_s);
    EXPECT_LE(norm(gcrs(t, t_s).position_m - truth.position_m), 2e-6) << t_s;
    EXPECT_LE(norm(gcrs(t, t_s).velocity_m_per_s - truth.velocity_m_per_s), 1e-6) << t_s;
  }
}

TEST(Oem, LagrangeAndLinearAreTakenAtTheirWord) {
  const Trajectory lagrange = parse_oem(
      header + meta("ICRF", "TAI", "INTERPOLATION = LAGRANGE\nINTERPOLATION_DEGREE = 9\n") +
          lines(0, 20),
      "t");
  const Trajectory linear =
      parse_oem(header + meta("ICRF", "TAI", "INTERPOLATION = LINEAR\n") + lines(0, 20), "t");
  const TwoBodyState truth = propagate_two_body(start, 630);
  EXPECT_LE(norm(gcrs(lagrange, 630).position_m - truth.position_m), 1e-4);
  const double bulge_m = norm(gcrs(linear, 630).position_m - truth.position_m);
  EXPECT_GT(bulge_m, 1000);  // g h^2 / 8 of a minute
  EXPECT_LT(bulge_m, 4000);
}

TEST(Oem, OutsideItsSpanIsAnErrorThatNamesTheSpan) {
  const Trajectory t = parse_oem(header + meta("GCRF", "UTC") + lines(0, 20), "t.oem");
  EXPECT_NO_THROW(state_at(t, at(37)));
  try {
    state_at(t, at(37 + 1200.5));
    FAIL();
  } catch (const Error& error) {
    EXPECT_STREQ(error.what(),
                 "t.oem: INSPECTOR: no state at 2026-01-01T00:20:00.500; the trajectory spans "
                 "2026-01-01T00:00:00.000 to 2026-01-01T00:20:00.000 UTC");
  }
  const Trajectory usable = parse_oem(
      header + meta("GCRF", "TAI", "USEABLE_START_TIME = 2026-001T00:02:00\n") + lines(0, 20), "t");
  EXPECT_THROW(state_at(usable, at(100)), Error);
  EXPECT_NO_THROW(state_at(usable, at(120)));
}

// TAI - UTC is 37 s in 2026, TAI - GPS 19 s, TT - TAI 32.184 s.
TEST(Oem, TimeSystemsDifferByTheirOffsets) {
  const struct {
    const char* system;
    double offset_s;
  } systems[] = {{"UTC", 37}, {"TAI", 0}, {"GPS", 19}, {"TT", -32.184}};
  for (const auto& s : systems) {
    const Trajectory t = parse_oem(header + meta("GCRF", s.system) + lines(0, 20), "t");
    const TwoBodyState truth = propagate_two_body(start, 300);
    EXPECT_LE(norm(gcrs(t, 300 + s.offset_s).position_m - truth.position_m), 1e-5) << s.system;
  }
}

// Reference: astropy 5.2, Time(text, scale="tdb").tai; tests/reference/oem_times.py.
TEST(Oem, TdbDiffersFromTtByItsPeriodicTerms) {
  const Trajectory january = parse_oem(header + meta("GCRF", "TDB") + lines(0, 20), "t");
  EXPECT_NEAR(seconds_between(at(0), january.reference), -32.1839180, 2e-6);
  const Trajectory april =
      parse_oem(header + meta("GCRF", "TDB") + line("2026-04-01T00:00:00", start), "t");
  EXPECT_NEAR(seconds_between(at(90 * day_s), april.reference), -32.1856299, 2e-6);
}

/// The path of `lines` in XML, with units as CCSDS 505.0-B writes them.
std::string oem_xml(const std::string& unit = "km") {
  std::string text =
      "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n<oem id=\"CCSDS_OEM_VERS\" version=\"2.0\">\n"
      "<header><CREATION_DATE>2026-01-01T00:00:00</CREATION_DATE><ORIGINATOR>T</ORIGINATOR>"
      "</header>\n<body><segment>\n<metadata>\n<OBJECT_NAME>INSPECTOR</OBJECT_NAME>\n"
      "<OBJECT_ID>2026-001A</OBJECT_ID>\n<CENTER_NAME>EARTH</CENTER_NAME>\n"
      "<REF_FRAME>GCRF</REF_FRAME>\n<TIME_SYSTEM>TAI</TIME_SYSTEM>\n</metadata>\n<data>\n";
  for (int m = 0; m <= 20; ++m) {
    const TwoBodyState s = propagate_two_body(start, 60.0 * m);
    char state[800];
    std::snprintf(state, sizeof state,
                  "<stateVector><EPOCH>2026-01-01T00:%02d:00.000</EPOCH><X units=\"%s\">%.12f</X>"
                  "<Y>%.12f</Y><Z>%.12f</Z><X_DOT units=\"km/s\">%.15f</X_DOT>"
                  "<Y_DOT>%.15f</Y_DOT><Z_DOT>%.15f</Z_DOT></stateVector>\n",
                  m, unit.c_str(), s.position_m.x / km, s.position_m.y / km, s.position_m.z / km,
                  s.velocity_m_per_s.x / km, s.velocity_m_per_s.y / km, s.velocity_m_per_s.z / km);
    text += state;
  }
  return text + "</data></segment></body></oem>\n";
}

TEST(Oem, XmlIsReadAsKvn) {
  const Trajectory kvn = parse_oem(header + meta() + lines(0, 20), "t"),
                   xml = parse_oem(oem_xml(), "t");
  ASSERT_EQ(xml.segments.size(), 1u);
  EXPECT_EQ(xml.segments[0].object_name, "INSPECTOR");
  EXPECT_EQ(xml.segments[0].time_s, kvn.segments[0].time_s);
  EXPECT_LE(norm(gcrs(xml, 300).position_m - gcrs(kvn, 300).position_m), 1e-9);
  for (const auto& [text, message] : {std::pair<std::string, std::string>{
                                          oem_xml("m"), "t:13: the unit of X is not km, got \"m\""},
                                      {oem_xml().substr(0, 700), "invalid XML"},
                                      {"<omm></omm>", "t: not a CCSDS OEM"}}) {
    try {
      parse_oem(text, "t");
      ADD_FAILURE() << message;
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), HasSubstr(message));
    }
  }
}

TEST(Oem, LeapSecondIsASecondLong) {
  const std::string text = header + meta("GCRF", "UTC") +
                           line("2016-12-31T23:59:00", propagate_two_body(start, 0)) +
                           line("2016-12-31T23:59:60", propagate_two_body(start, 60)) +
                           line("2017-01-01T00:00:59", propagate_two_body(start, 120));
  const Trajectory t = parse_oem(text, "t");
  EXPECT_NEAR(t.segments[0].time_s[1], 60, 1e-9);
  EXPECT_NEAR(t.segments[0].time_s[2], 120, 1e-9);
}

TEST(Oem, SegmentsMayJump) {
  TwoBodyState other = start;
  other.position_m.x += 5000;
  std::string second;
  for (int k = 0; k < 3; ++k) {
    char time[40];
    std::snprintf(time, sizeof time, "2026-01-01T00:%02d:00", 5 + k);
    second += line(time, other);
  }
  const Trajectory t = parse_oem(header + meta() + lines(0, 5) + meta() + second, "t");
  EXPECT_LE(norm(gcrs(t, 299.9).position_m - propagate_two_body(start, 299.9).position_m), 1e-3);
  EXPECT_LE(norm(gcrs(t, 300).position_m - other.position_m), 1e-3);
}

// A state alone covers its instant, whatever its interpolation.
TEST(Oem, ASegmentMayBeOneState) {
  for (const char* kind : {"LINEAR", "LAGRANGE", "HERMITE"}) {
    const Trajectory t = parse_oem(
        header + meta("GCRF", "TAI", std::string("INTERPOLATION = ") + kind + "\n") + lines(3, 3),
        "t");
    const TwoBodyState truth = propagate_two_body(start, 180);
    for (const FramedState& read : {state_at(t, at(180)), path_at(t, at(180))}) {
      const auto& state = std::get<MotionState<Gcrs>>(read);
      EXPECT_LE(norm(state.position_m - truth.position_m), 1e-5) << kind;
      EXPECT_LE(norm(state.velocity_m_per_s - truth.velocity_m_per_s), 1e-8) << kind;
    }
    EXPECT_FALSE(covers(t, at(180.001)));
  }
}

// The bias of EME2000's pole is (-16.6, -6.8) mas (IERS Conventions 2010, chapter 5).
TEST(Oem, FramesAreKeptAndEme2000IsTurnedByTheFrameBias) {
  const TwoBodyState pole{{0, 0, 7e6}, {7e3, 0, 0}};
  const auto text = [&](const char* frame) {
    return header + meta(frame) + line("2026-01-01T00:00:00", pole) +
           line("2026-01-01T00:01:00", pole);
  };
  const Vec<Gcrs> turned = gcrs(parse_oem(text("EME2000"), "t"), 0).position_m;
  EXPECT_NEAR(turned.x / 7e6 / mas, -16.617, 0.01);
  EXPECT_NEAR(turned.y / 7e6 / mas, -6.819, 0.01);
  EXPECT_TRUE(
      std::holds_alternative<MotionState<Itrs>>(state_at(parse_oem(text("ITRF2014"), "t"), at(0))));
  EXPECT_TRUE(
      std::holds_alternative<MotionState<Teme>>(state_at(parse_oem(text("TEME"), "t"), at(0))));
}

TEST(Oem, FaultsPointAtTheirLine) {
  const struct {
    std::string text, message;
  } cases[] = {
      {header + meta("MOD") + lines(0, 2), "t:8: REF_FRAME is not supported, got \"MOD\""},
      {header + meta("GCRF", "UT1") + lines(0, 2),
       "t:9: TIME_SYSTEM is not supported, got \"UT1\""},
      {header + meta() + lines(3, 4) + lines(0, 1), "t:13: times must increase"},
      {header + meta() + "2026-01-01T00:00:00 1 2 3 4 5\n",
       "t:11: expected a time and 6 or 9 numbers"},
      {header + meta() + "2026-01-01T00:00:00 1 2 3 4 5 x\n", "t:11: not a number, got \"x\""},
      {header + meta() + "2026-13-01T00:00:00 1 2 3 4 5 6\n", "t:11: not a time"},
      {header + meta(), "t:10: a segment needs an ephemeris line, got \"INSPECTOR\""},
      {header + meta() + lines(0, 1) + named("TARGET", "2026-001A") + lines(2, 3),
       "t:14: OBJECT_NAME is another than the first segment's, INSPECTOR: a trajectory is of one "
       "object, got \"TARGET\""},
      {header + meta() + lines(0, 1) + named("INSPECTOR", "2") + lines(2, 3),
       "t:15: OBJECT_ID is another than the first segment's, 2026-001A: a trajectory is of one "
       "object, got \"2\""},
      {header + "META_START\nREF_FRAME = GCRF\nMETA_STOP\n", "t:6: segment without TIME_SYSTEM"},
      {header + "COVARIANCE_START\nCOVARIANCE_STOP\n" + lines(0, 2),
       "t:4: COVARIANCE_START outside the ephemeris lines"},
      {header + "COVARIANCE_STOP\n" + lines(0, 2), "t:4: COVARIANCE_STOP without COVARIANCE_START"},
      {meta() + lines(0, 2), "t: not a CCSDS OEM"},
      {header, "t: contains no ephemeris segment"}};
  for (const auto& c : cases) {
    try {
      parse_oem(c.text, "t");
      ADD_FAILURE() << c.message;
    } catch (const ConfigError& error) {
      EXPECT_THAT(error.what(), HasSubstr(c.message));
    }
  }
}

TEST(Motion, EveryModelAnswersThroughOneCall) {
  const MotionModel models[] = {ConstantPosition<Itrs>{{6378137, 0, 0}},
                                ConstantPosition<Gcrs>{{4e7, 0, 0}}, TwoBodyMotion{at(100), start},
                                parse_oem(header + meta() + lines(0, 20), "t")};
  EXPECT_EQ(std::get<MotionState<Itrs>>(state_at(models[0], at(5))).position_m.x, 6378137);
  EXPECT_EQ(std::get<MotionState<Gcrs>>(state_at(models[1], at(5))).velocity_m_per_s.x, 0);
  const auto two_body = std::get<MotionState<Gcrs>>(state_at(models[2], at(700)));
  EXPECT_LE(norm(two_body.position_m - propagate_two_body(start, 600).position_m), 1e-5);
  const auto trajectory = std::get<MotionState<Gcrs>>(state_at(models[3], at(600)));
  EXPECT_LE(norm(trajectory.position_m - two_body.position_m), 1e-4);
}

}  // namespace
}  // namespace dmise
