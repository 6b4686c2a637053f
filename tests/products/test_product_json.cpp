#include "core/products/product_json.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/units.h"

namespace dmise {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

Track some_track() {
  Track t{.id = 7, .status = TrackStatus::lost, .time = {-5}};
  t.position_m = {1.5, -2e7, 3};
  t.velocity_m_per_s = {-7e3, 0, 1e-3};
  for (std::size_t k = 0; k < t.covariance.size(); ++k) t.covariance[k] = 0.1 * double(k);
  t.drag_m2_per_kg = 0.02, t.drag_sigma_m2_per_kg = 0.01;
  t.srp_m2_per_kg = 0.03, t.srp_sigma_m2_per_kg = 0.04;
  t.catalogue_number = 25544, t.name = "ISS \"Zarya\"";
  t.existence = 0.875, t.detections = 12;
  t.associated = {"eye/1/2", "ear/3/4"};
  t.innovation_d2 = 2.25, t.last_seen = {1'000'000'007}, t.magnitude = -1.5;
  return t;
}

std::string line_of(const Track& track) {
  return to_json(track, [](SimTime) { return std::string("2018-01-21T00:15:00Z"); });
}

TEST(TrackJson, ReadsEveryFieldThatALineHas) {
  EXPECT_EQ(track_of(JsonRecord(line_of(some_track()), "tracks.jsonl:1")), some_track());
  EXPECT_EQ(track_of(JsonRecord(line_of(Track{}), "tracks.jsonl:1")), Track{});
}

TEST(TrackJson, RefusesAStatusThatThereIsNot) {
  std::string line = line_of(some_track());
  line.replace(line.find("lost"), 4, "tost");
  try {
    track_of(JsonRecord(line, "tracks.jsonl:3"));
    FAIL();
  } catch (const ConfigError& error) {
    EXPECT_STREQ(error.what(),
                 "tracks.jsonl:3: status: must be one of tentative, confirmed, lost, did you mean "
                 "lost?, got tost");
  }
}

Detection streak_with_light() {
  Detection d{.id = "eye/1/0", .sensor = "eye", .frame = 1, .kind = DetectionKind::streak};
  d.light_curve = LightCurve{.bin_px = 2.5,
                             .along_px = {1.25, 3.75},
                             .time_s = {0.5, 1.5},
                             .light_e = {1000, -20},
                             .sigma_e = {40, 30},
                             .correlation = {-0.25, 0},
                             .period = LightPeriod{.period_px = 12.5,
                                                   .period_sigma_px = 0.125,
                                                   .period_s = 5,
                                                   .period_sigma_s = 0.5,
                                                   .amplitude = 0.75,
                                                   .amplitude_sigma = 0.0625,
                                                   .harmonics = 3,
                                                   .false_alarm = 1e-9},
                             .min_period_px = 7.5,
                             .min_period_s = 3};
  return d;
}

std::string line_of(const Detection& d, const UnknownFacts& unknown = {}) {
  return to_json(
      d, [](SimTime) { return std::string("2018-01-21T00:15:00Z"); }, unknown);
}

TEST(DetectionJson, ReadsTheLightCurveThatALineHas) {
  const Detection d = streak_with_light();
  EXPECT_EQ(detection_of(JsonRecord(line_of(d), "detections.jsonl:1")).light_curve, d.light_curve);
  EXPECT_THAT(line_of(Detection{}), testing::Not(HasSubstr("light_curve")));
}

TEST(DetectionJson, HasNoTimesOfALightCurveWithoutAnExposureTime) {
  UnknownFacts unknown;
  unknown.add(FrameFact::exposure);
  const std::string line = line_of(streak_with_light(), unknown);
  EXPECT_THAT(line, AllOf(HasSubstr("\"time_s\":null"), HasSubstr("\"period_s\":null")));
}

TEST(DetectionJson, RefusesALightCurveOfListsOfOtherLengths) {
  std::string line = line_of(streak_with_light());
  line.replace(line.find("[40"), 1, "[1,");
  EXPECT_THROW(detection_of(JsonRecord(line, "detections.jsonl:1")), ConfigError);
}

FrameReport report_of(const Wcs& wcs) {
  FrameReport report{.sensor = "eye", .frame = 1};
  report.wcs = wcs;
  return report;
}

Wcs read_back(const Wcs& wcs) {
  const std::string line = to_json(report_of(wcs), [](SimTime) { return std::string("now"); });
  Wcs back = wcs_of(JsonRecord(line, "frames.jsonl:1").object("wcs"));
  // Written in degrees.
  EXPECT_NEAR(back.ra_rad, wcs.ra_rad, 1e-15);
  EXPECT_NEAR(back.dec_rad, wcs.dec_rad, 1e-15);
  back.ra_rad = wcs.ra_rad;
  back.dec_rad = wcs.dec_rad;
  return back;
}

TEST(WcsJson, ReadsWhatIsWritten) {
  Wcs wcs{.projection = Projection::gnomonic,
          .crpix_x = 99.5,
          .crpix_y = 49.5,
          .ra_rad = 30 * deg,
          .dec_rad = -60 * deg,
          .cd_deg = {-0.02, 0.001, 0.001, 0.02},
          .rms_px = 0.01,
          .max_px = 0.02};
  EXPECT_EQ(read_back(wcs), wcs);
  wcs.projection = Projection::equidistant;
  wcs.order = 2;
  wcs.a = wcs.b = wcs.ap = wcs.bp = {0, 1e-3, 1e-6, 2e-3, 1e-7, 0, 3e-6, 0, 0};
  wcs.refraction = WcsRefraction{.zenith = {0, 0, 1},
                                 .focal_length_px = 500,
                                 .lens = Projection::stereographic,
                                 .pressure_hpa = 1000,
                                 .temperature_c = 10,
                                 .humidity = 0.5,
                                 .wavelength_um = 0.55,
                                 .offset_x_px = 0.1,
                                 .offset_y_px = 0.2,
                                 .cell_px = 8};
  EXPECT_EQ(read_back(wcs), wcs);
}

TEST(WcsJson, RefusesWhatIsNone) {
  const std::string good =
      R"({"projection":"TAN","crpix_px":[1,2],"crval_deg":[0,0],"cd_deg_per_px":[1,0,0,1],"order":0,"rms_px":0,"max_px":0})";
  EXPECT_NO_THROW(wcs_of(JsonRecord(good, "F:1")));
  for (const auto& [from, to] :
       {std::pair("TAN", "TAG"), std::pair("[1,0,0,1]", "[1,1,1,1]"),
        std::pair("\"order\":0", "\"order\":10"), std::pair("\"order\":0", "\"order\":2"),
        std::pair("[1,2]", "[1]")}) {
    std::string bad = good;
    bad.replace(bad.find(from), std::string(from).size(), to);
    EXPECT_THROW(wcs_of(JsonRecord(bad, "F:1")), ConfigError) << bad;
  }
}

TEST(WcsJson, NamesOfProjectionsHaveASuggestion) {
  const std::string good =
      R"({"projection":"TAN","crpix_px":[1,2],"crval_deg":[0,0],"cd_deg_per_px":[1,0,0,1],"order":0,"rms_px":0,"max_px":0,)"
      R"("refraction":{"zenith":[0,0,1],"offset_px":[0,0],"focal_length_px":500,"pressure_hpa":1000,)"
      R"("temperature_c":10,"humidity":0.5,"wavelength_um":0.55,"cell_px":8,"lens":"equidistant"}})";
  EXPECT_NO_THROW(wcs_of(JsonRecord(good, "F:1")));
  for (const auto& [right, wrong] :
       {std::pair("TAN", "TNA"), std::pair("equidistant", "equidistent")}) {
    std::string bad = good;
    bad.replace(bad.find(right), std::string(right).size(), wrong);
    EXPECT_THAT(
        [&] { wcs_of(JsonRecord(bad, "F:1")); },
        ThrowsMessage<ConfigError>(AllOf(HasSubstr("did you mean " + std::string(right) + "?"),
                                         HasSubstr("got " + std::string(wrong)))));
  }
}

}  // namespace
}  // namespace dmise
