#include "core/exchange/export_format.h"

#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/error.h"
#include "tests/exchange/small_run.h"

namespace dmise {
namespace {

using Json = nlohmann::json;

std::vector<ExportedFile> exported(const std::string& format, const ExportRequest& request) {
  for (const ExportFormat& f : export_formats())
    if (f.name == format) return f.files(request);
  ADD_FAILURE() << format;
  return {};
}

// The pixel centre of COCO is at + 0.5.
TEST(ExportFormat, CocoHasBoxesFromCornersOfPixels) {
  const RunProducts run = run_with_truth();
  const Json coco = Json::parse(exported("coco", {run, ProductKind::truth, {}})[0].content);
  EXPECT_EQ(coco["images"][0]["file_name"], "eye/frame-000007.fits");
  const auto& annotation = coco["annotations"][0];
  const double margin_px = (annotation["bbox"][2].get<double>() - 40.0) / 2.0;
  EXPECT_GT(margin_px, 1.0);
  EXPECT_NEAR(annotation["bbox"][0].get<double>(), 20.5 - margin_px, 1e-9);
  EXPECT_NEAR(annotation["bbox"][1].get<double>(), 30.5 - margin_px, 1e-9);
  EXPECT_EQ(annotation["image_id"], coco["images"][0]["id"]);
  EXPECT_EQ(annotation["keypoints"], Json::parse("[20.5,30.5,2,60.5,50.5,2]"));
}

TEST(ExportFormat, CocoLabelsOnlyKeypointsInTheImage) {
  RunProducts run = run_with_truth();
  run.truths[0].end_x_px = 260;
  const Json coco = Json::parse(exported("coco", {run, ProductKind::truth, {}})[0].content);
  const auto& annotation = coco["annotations"][0];
  EXPECT_EQ(annotation["keypoints"], Json::parse("[20.5,30.5,2,0.0,0.0,0]"));
  EXPECT_EQ(annotation["num_keypoints"], 1);
}

TEST(ExportFormat, SatnetHasFractionsOfTheImage) {
  const RunProducts run = run_with_truth();
  const auto files = exported("satnet", {run, ProductKind::truth, {}});
  ASSERT_EQ(files.size(), 1u);  // there is no image
  EXPECT_EQ(files[0].path, "eye/Annotations/eye.0007.json");
  const Json data = Json::parse(files[0].content)["data"];
  EXPECT_EQ(data["objects"].size(), 1u);
  EXPECT_NEAR(data["objects"][0]["x_center"].get<double>(), 40.5 / 200, 1e-12);
  EXPECT_NEAR(data["objects"][0]["y_center"].get<double>(), 40.5 / 100, 1e-12);
  EXPECT_NEAR(data["objects"][0]["pe_per_sec"].get<double>(), 5e3, 1e-9);
}

TEST(ExportFormat, UdlHasDegreesAndKilometres) {
  const RunProducts found = run_with_detection(), known = run_with_truth();
  const Json d = Json::parse(exported("udl", {found, ProductKind::detections, {}})[0].content)[0];
  EXPECT_NEAR(d["ra"].get<double>(), 350.0, 1e-12);
  EXPECT_NEAR(d["declinationUnc"].get<double>(), 2.0 / 3600.0, 1e-12);
  EXPECT_EQ(d["obTime"], "2018-01-21T00:15:01.000000Z");
  EXPECT_NEAR(d["senalt"].get<double>(), 0.3, 1e-12);
  const Json t = Json::parse(exported("udl", {known, ProductKind::truth, {}})[0].content)[0];
  EXPECT_NEAR(t["range"].get<double>(), 500.0, 1e-12);
  EXPECT_EQ(t["penumbra"], true);
  EXPECT_EQ(t["satNo"], 25544);
}

// A sensor whose clock is half a second slow, on the ground and in orbit: senx and senvelx are of
// obTime, as the object's direction and range. The frame has them at the sensor's own middle.
TEST(ExportFormat, UdlOfTruthHasTheSensorAtTheTrueTime) {
  for (const double radius_m : {6.37e6, 7e6})
    for (const bool light_time : {true, false}) {
      const double rate =
          radius_m < 6.5e6 ? 7.292115e-5 : std::sqrt(3.986e14 / std::pow(radius_m, 3));
      const auto at = [&](double t_s) {
        return Vec<Gcrs>{radius_m * std::cos(rate * t_s), radius_m * std::sin(rate * t_s), 0};
      };
      const auto going = [&](double t_s) {
        return Vec<Gcrs>{-radius_m * rate * std::sin(rate * t_s),
                         radius_m * rate * std::cos(rate * t_s), 0};
      };
      RunProducts run = run_with_truth();
      run.sensors[0].light_time = light_time;
      run.frames[0].sensor_position_m = at(0.0);
      run.frames[0].sensor_velocity_m_per_s = going(0.0);
      Truth& t = run.truths[0];
      t.middle = run.frames[0].middle + sim_seconds(0.5);
      t.true_position_m = {7.3e6, 1e6, 8e5};
      t.true_velocity_m_per_s = {1e3, -6e3, 4e3};
      const Vec<Gcrs> line = t.true_position_m - at(0.5);
      t.true_range_m = norm(line);
      Vec<Gcrs> seen = line;
      for (int i = 0; light_time && i < 3; ++i)
        seen = line - t.true_velocity_m_per_s * (norm(seen) / speed_of_light_m_per_s);
      const auto [ra, dec] = to_spherical(seen);
      t.true_ra_rad = ra, t.true_dec_rad = dec;
      const Json r = Json::parse(exported("udl", {run, ProductKind::truth, {}})[0].content)[0];
      EXPECT_EQ(r["obTime"], "2018-01-21T00:15:01.500000Z");
      const Vec<Gcrs> p{r["senx"].get<double>(), r["seny"].get<double>(), r["senz"].get<double>()},
          v{r["senvelx"].get<double>(), r["senvely"].get<double>(), r["senvelz"].get<double>()};
      EXPECT_LT(norm(p * km - at(0.5)), 1e-5) << radius_m;
      EXPECT_LT(norm(v * km - going(0.5)), 1e-3) << radius_m;  // in orbit it gains 4 m/s
    }
}

TEST(ExportFormat, OmmIsInDegreesAndRevolutions) {
  const RunProducts run = small_run();
  MeanElements e{.catalogue_number = 5, .name = "a<b", .epoch_jd1 = 2458139.5};
  e.mean_motion_rad_per_min = 2.0 * pi / 96.0;
  e.inclination_rad = 0.5 * pi;
  const auto files = exported("omm", {run, ProductKind::truth, {e}});
  EXPECT_TRUE(has(files[0].content, "<MEAN_MOTION>15</MEAN_MOTION>"));
  EXPECT_TRUE(has(files[0].content, "<INCLINATION>90</INCLINATION>"));
  EXPECT_TRUE(has(files[0].content, "<OBJECT_NAME>a&lt;b</OBJECT_NAME>"));
}

TEST(ExportFormat, MessagesThatNeedASegmentRefuseAnEmptyRun) {
  const RunProducts run = small_run();
  EXPECT_THROW(exported("oem", {run, ProductKind::truth, {}}), ConfigError);
  EXPECT_THROW(exported("omm", {run, ProductKind::truth, {}}), ConfigError);
}

// Reference: OWASP, CSV Injection: cells that begin with = + - @, a tab or a carriage return.
TEST(ExportFormat, CsvHasNoFormulasForSpreadsheets) {
  RunProducts run = small_run();
  run.directory = testing::TempDir() + "/formulas";
  std::filesystem::create_directories(run.directory);
  std::ofstream(run.directory + "/detections.jsonl")
      << R"json({"sensor":"eye","frame":7,"a":"=HYPERLINK(\"http://x\")","b":"+1","c":"@SUM(1)",)json"
      << R"json("d":"\t=1","e":"-2","f":-2.5,"g":"5-2","=1+1":1})json"
      << "\n";
  std::ofstream(run.directory + "/frames.jsonl") << "";
  const auto files = exported("csv", {run, ProductKind::detections, {}});
  EXPECT_EQ(files[0].content,
            "sensor,frame,a,b,c,d,e,f,g,'=1+1\r\n"
            "eye,7,\"'=HYPERLINK(\"\"http://x\"\")\",'+1,'@SUM(1),'\t=1,'-2,-2.5,5-2,1\r\n");
  std::filesystem::remove_all(run.directory);
}

// Reference: RFC 4180 2.5 to 2.7.
TEST(ExportFormat, CsvQuotesAndLeavesOutOtherSensors) {
  RunProducts run = small_run();
  run.directory = testing::TempDir() + "/csv";
  std::filesystem::create_directories(run.directory);
  std::ofstream(run.directory + "/detections.jsonl")
      << "{\"id\":\"a,\\\"b\",\"sensor\":\"eye\",\"frame\":7,\"covariance_px2\":[1,0.5,2]}\n"
      << "{\"id\":\"other\",\"sensor\":\"ear\",\"frame\":7}\n";
  std::ofstream(run.directory + "/frames.jsonl") << "";
  const auto files = exported("csv", {run, ProductKind::detections, {}});
  ASSERT_EQ(files.size(), 2u);
  EXPECT_EQ(files[0].content,
            "id,sensor,frame,covariance_px2_xx,covariance_px2_xy,covariance_px2_yy\r\n"
            "\"a,\"\"b\",eye,7,1,0.5,2\r\n");
  EXPECT_EQ(files[1].content, "");
  std::filesystem::remove_all(run.directory);
}

}  // namespace
}  // namespace dmise
