#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/base/units.h"
#include "core/detection/detection_json.h"
#include "core/products/frame_report.h"
#include "core/score/wcs_record.h"

namespace dmise {
namespace {

using testing::AllOf;
using testing::HasSubstr;
using testing::ThrowsMessage;

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

TEST(WcsRecord, ReadsWhatIsWritten) {
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

TEST(WcsRecord, RefusesWhatIsNone) {
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

TEST(WcsRecord, NamesOfProjectionsHaveASuggestion) {
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
