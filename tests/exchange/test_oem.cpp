#include "core/exchange/oem.h"

#include <gtest/gtest.h>

#include "core/base/error.h"
#include "core/exchange/export_format.h"
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

TEST(OemText, OfTracksHasASegmentForEachThatIsConfirmed) {
  RunProducts run{.clock = Clock(parse_utc("2018-01-21T00:15:00Z"))};
  const auto add = [&](std::uint32_t id, TrackStatus status, double time_s, const char* name) {
    Track t{.id = id, .status = status, .time = sim_seconds(time_s)};
    t.position_m = {7e6, 0, 0}, t.velocity_m_per_s = {0, 7500, 0};
    t.covariance[0] = 4e6;
    t.name = name;
    t.catalogue_number = *name ? 25544 : 0;
    run.tracks.push_back(t);
  };
  add(1, TrackStatus::tentative, 0, "ISS");
  add(1, TrackStatus::confirmed, 10, "ISS");
  add(2, TrackStatus::tentative, 10, "");
  add(3, TrackStatus::confirmed, 10, "");
  add(1, TrackStatus::confirmed, 20, "ISS");
  const std::string text = run_oem_text({run, ProductKind::tracks, {}});
  const auto count = [&](const std::string& what) {
    std::size_t n = 0;
    for (auto at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
    return n;
  };
  EXPECT_EQ(count("META_START"), 2u);
  EXPECT_EQ(count("OBJECT_NAME = ISS\nOBJECT_ID = 25544\n"), 1u);
  EXPECT_EQ(count("OBJECT_NAME = TRACK 3\nOBJECT_ID = TRACK 3\n"), 1u);
  EXPECT_EQ(count("\n4.000000000000000e+00\n"), 3u);
  run.tracks.resize(1);
  EXPECT_THROW(run_oem_text({run, ProductKind::tracks, {}}), ConfigError);
}

TEST(OemText, KeepsCommentsInPrintableAscii) {
  const RunProducts run{.clock = Clock(parse_utc("2018-01-21T00:15:00Z"))};
  const std::string text = oem_text(run, {{"a\nb\xc3\xa9", "1", {EphemerisState{}}}});
  EXPECT_NE(text.find("OBJECT_NAME = a?b??\n"), std::string::npos) << text;
}

}  // namespace
}  // namespace dmise
