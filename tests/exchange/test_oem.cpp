#include "core/exchange/oem.h"

#include <gtest/gtest.h>

#include "core/orbit/oem.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

// Reference: CCSDS 502.0-B-2, 5.2.5: kilometres, the lower triangle row by row, after its epoch.
TEST(OemText, HasTheCovarianceInKilometres) {
  const RunProducts run{.clock = Clock(parse_utc("2018-01-21T00:15:00Z"))};
  EphemerisState state{{0}, {7e6, 0, 0}, {0, 7500, 0}, std::array<double, 21>{}};
  for (std::size_t i = 0; i < 21; ++i) (*state.covariance)[i] = double(i + 1);
  const std::string text = oem_text(run, {{"X", "1", {state}}});
  EXPECT_NE(text.find("\n2018-01-21T00:15:00.000000000Z 7000.000000000 0.000000000 0.000000000 "
                      "0.000000000000 7.500000000000 0.000000000000\nCOVARIANCE_START\nEPOCH = "
                      "2018-01-21T00:15:00.000000000Z\nCOV_REF_FRAME = GCRF\n"
                      "1.000000000000000e-06\n2.000000000000000e-06 3.000000000000000e-06\n"),
            std::string::npos)
      << text;
  EXPECT_NE(text.find(" 2.100000000000000e-05\nCOVARIANCE_STOP\n"), std::string::npos) << text;
}

TEST(OemText, KeepsCommentsInPrintableAscii) {
  const RunProducts run{.clock = Clock(parse_utc("2018-01-21T00:15:00Z"))};
  const std::string text = oem_text(run, {{"a\nb\xc3\xa9", "1", {EphemerisState{}}}});
  EXPECT_NE(text.find("OBJECT_NAME = a?b??\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace dmise
