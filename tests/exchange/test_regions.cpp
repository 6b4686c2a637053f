#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "core/exchange/czml.h"
#include "core/exchange/regions.h"
#include "tests/exchange/small_run.h"

namespace dmise {
namespace {

using testing::HasSubstr;
using testing::Not;

// DS9's reference: image coordinates begin with 1 at the centre of the first pixel.
TEST(Regions, CountPixelsFromOne) {
  const RunProducts run = run_with_truth();
  const auto files = region_files({.run = run, .kind = ProductKind::truth, .elements = {}});
  ASSERT_EQ(files.size(), 1u);  // no WCS, no ICRS
  EXPECT_EQ(files[0].path, "eye/frame-000007-truth.image.reg");
  EXPECT_THAT(files[0].content, HasSubstr("line(21.000,31.000,41.000,41.000)"));
  EXPECT_THAT(files[0].content, HasSubstr("text={ISS}"));
}

TEST(Regions, NamesCanNotEndTheirText) {
  RunProducts run = run_with_truth();
  run.truths[0].name = "a} # color=red\nline(1,2,3,4)";
  const auto files = region_files({.run = run, .kind = ProductKind::truth, .elements = {}});
  EXPECT_THAT(files[0].content, HasSubstr("text={a) # color=red line(1,2,3,4)}"));
}

TEST(Regions, AFrameWithoutDetectionsHasAFileToo) {
  const RunProducts run = small_run();
  const auto files = region_files({.run = run, .kind = ProductKind::detections, .elements = {}});
  ASSERT_EQ(files.size(), 1u);
  EXPECT_THAT(files[0].content, Not(HasSubstr("circle")));
}

TEST(Czml, EscapesWhatSeparatesInReferences) {
  RunProducts run = small_run();
  run.sensors[0].name = "e.y#e";
  run.frames[0].sensor = "e.y#e";
  run.frames[0].wcs = Wcs{.crpix_x = 99.5, .crpix_y = 49.5, .cd_deg = {-0.02, 0, 0, 0.02}};
  const std::string text = czml_text({.run = run, .kind = ProductKind::truth, .elements = {}});
  EXPECT_THAT(text, HasSubstr(R"("sensor/e\\.y\\#e#position")"));
  EXPECT_THAT(text, HasSubstr(R"("id":"sensor/e.y#e")"));
}

}  // namespace
}  // namespace dmise
