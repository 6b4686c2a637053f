#include "core/conjunction/cdm.h"

#include <gtest/gtest.h>

#include <map>
#include <sstream>

namespace dmise {
namespace {

/// Values of keys, those of the second object behind "2.".
std::map<std::string, std::string> values(const std::string& text) {
  std::map<std::string, std::string> out;
  std::istringstream lines(text);
  std::string prefix;
  for (std::string line; std::getline(lines, line);) {
    const auto at = line.find(" = ");
    EXPECT_NE(at, std::string::npos) << line;
    std::string value = line.substr(at + 3);
    if (line.substr(0, at) == "OBJECT" && value == "OBJECT2") prefix = "2.";
    out[prefix + line.substr(0, at)] = value.substr(0, value.find(" ["));
  }
  return out;
}

Encounter example() {
  Encounter e;
  e.first.state = {.position_m = {7e6, 0, 0}, .velocity_m_per_s = {0, 7500, 0}};
  e.second.state = {.position_m = {7e6 + 100, 300, -50}, .velocity_m_per_s = {0, 0, 7500}};
  e.first.covariance.topLeftCorner<3, 3>() = Eigen::Vector3d(1, 4, 9).asDiagonal();
  e.second.covariance.topLeftCorner<3, 3>() = Eigen::Vector3d(1, 4, 9).asDiagonal();
  e.radius_m = 10;
  return e;
}

// CCSDS 508.0-B-1, tables 3-1 to 3-4: what must be there, in its units.
TEST(Cdm, HasAllThatIsObligatory) {
  const auto v = values(cdm_text(example(), {.created_utc = "2020-01-01T00:00:00",
                                             .message_id = "1",
                                             .closest_utc = "2020-01-02T00:00:00.125",
                                             .first = {"44720", "FIRST", "2019-001A"},
                                             .second = {"44721", "", ""},
                                             .probability = 1.5e-5}));
  for (const char* key :
       {"CCSDS_CDM_VERS", "CREATION_DATE", "ORIGINATOR", "MESSAGE_ID", "TCA", "MISS_DISTANCE"})
    EXPECT_TRUE(v.count(key)) << key;
  for (const std::string prefix : {"", "2."})
    for (const char* key : {"OBJECT",
                            "OBJECT_DESIGNATOR",
                            "CATALOG_NAME",
                            "OBJECT_NAME",
                            "INTERNATIONAL_DESIGNATOR",
                            "EPHEMERIS_NAME",
                            "COVARIANCE_METHOD",
                            "MANEUVERABLE",
                            "REF_FRAME",
                            "X",
                            "Y",
                            "Z",
                            "X_DOT",
                            "Y_DOT",
                            "Z_DOT",
                            "CR_R",
                            "CT_R",
                            "CT_T",
                            "CN_R",
                            "CN_T",
                            "CN_N",
                            "CRDOT_R",
                            "CRDOT_T",
                            "CRDOT_N",
                            "CRDOT_RDOT",
                            "CTDOT_R",
                            "CTDOT_T",
                            "CTDOT_N",
                            "CTDOT_RDOT",
                            "CTDOT_TDOT",
                            "CNDOT_R",
                            "CNDOT_T",
                            "CNDOT_N",
                            "CNDOT_RDOT",
                            "CNDOT_TDOT",
                            "CNDOT_NDOT"})
      EXPECT_TRUE(v.count(prefix + key)) << prefix + key;
  EXPECT_NEAR(std::stod(v.at("MISS_DISTANCE")), std::sqrt(100.0 * 100 + 300 * 300 + 50 * 50), 1e-3);
  EXPECT_NEAR(std::stod(v.at("X")), 7000, 1e-6);
  EXPECT_EQ(v.at("2.OBJECT_NAME"), "UNKNOWN");
  // The first moves along y: its axes are those of the frame. The second moves along z.
  EXPECT_NEAR(std::stod(v.at("CR_R")), 1, 1e-3);
  EXPECT_NEAR(std::stod(v.at("CT_T")), 4, 1e-3);
  EXPECT_NEAR(std::stod(v.at("CN_N")), 9, 1e-3);
  EXPECT_NEAR(std::stod(v.at("2.CT_T")), 9, 1e-2);
  EXPECT_NEAR(std::stod(v.at("2.CN_N")), 4, 1e-2);
}

}  // namespace
}  // namespace dmise
