#include "core/exchange/tdm.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "tests/exchange/small_run.h"

namespace dmise {
namespace {

// Reference: CCSDS 503.0-B-2, 3.3 and 3.5: degrees, UTC; corrections that were applied.
TEST(TdmText, HasDirectionsOfDetectionsAndTheirCorrections) {
  const RunProducts run = run_with_detection();
  const std::string text = tdm_text({run, ProductKind::detections, {}});
  EXPECT_EQ(text.find("CCSDS_TDM_VERS = 2.0\n"), 0u) << text;
  for (const char* line :
       {"PARTICIPANT_1 = eye\nPARTICIPANT_2 = UNKNOWN\n", "TIMETAG_REF = RECEIVE\n",
        "INTEGRATION_INTERVAL = 2\nINTEGRATION_REF = MIDDLE\n", "REFERENCE_FRAME = ICRF\n",
        "DATA_QUALITY = RAW\n", "CORRECTION_ANGLE_1 = 0.001000000\n",
        "CORRECTION_ANGLE_2 = -0.002000000\n",
        "ANGLE_1 = 2018-01-21T00:15:01.000000000Z 350.000000000\n",
        "ANGLE_2 = 2018-01-21T00:15:01.000000000Z 20.000000000\n",
        "MAG = 2018-01-21T00:15:01.000000000Z 8.500000\n"})
    EXPECT_TRUE(has(text, line)) << line << text;
}

TEST(TdmText, HasTheMeanBrightnessOfTruth) {
  const RunProducts run = run_with_truth();
  const std::string text = tdm_text({run, ProductKind::truth, {}});
  EXPECT_TRUE(has(text, "PARTICIPANT_2 = 25544\n")) << text;
  EXPECT_TRUE(has(text, "DATA_QUALITY = VALIDATED\n")) << text;
  EXPECT_TRUE(has(text, " 3.752575\n")) << text;  // half of the light: 0.7526 mag fainter
}

// Reference: CCSDS 503.0-B-2, 3.5: angles are below 360 deg.
TEST(TdmText, RightAscensionIsNeverRoundedTo360) {
  RunProducts run = run_with_detection();
  run.detections[0].corrected_ra_rad = -1e-12 * deg;
  EXPECT_TRUE(has(tdm_text({run, ProductKind::detections, {}}), "Z 0.000000000\n"));
}

TEST(TdmText, OfNothingIsRefused) {
  const RunProducts run = small_run();
  EXPECT_THROW(tdm_text({run, ProductKind::detections, {}}), ConfigError);
  EXPECT_THROW(tdm_text({run, ProductKind::truth, {}}), ConfigError);
}

}  // namespace
}  // namespace dmise
