#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <sstream>

#include "core/base/files/text_file.h"
#include "core/orbit/sgp4/sgp4_batch.h"
#include "tests/support/data.h"
#include "tests/support/simd.h"
#include "tests/support/tle.h"

namespace dmise {
namespace {

double distance_km(const Sgp4State& s, const double* r_km) {
  return std::hypot(s.position_m.x * 1e-3 - r_km[0], s.position_m.y * 1e-3 - r_km[1],
                    s.position_m.z * 1e-3 - r_km[2]);
}
double speed_km_s(const Sgp4State& s, const double* v_km_s) {
  return std::hypot(s.velocity_m_per_s.x * 1e-3 - v_km_s[0],
                    s.velocity_m_per_s.y * 1e-3 - v_km_s[1],
                    s.velocity_m_per_s.z * 1e-3 - v_km_s[2]);
}

class Sgp4Verification : public testing::TestWithParam<SimdLevel> {};
INSTANTIATE_TEST_SUITE_P(Simd, Sgp4Verification, testing::ValuesIn(test::simd_here()),
                         test::simd_name);

// Reference: SGP4-VER.TLE and tcppver.out of AIAA 2006-6753 as python-sgp4 distributes them: mode
// 'i', WGS72, positions printed to 1e-8 km, velocities to 1e-9 km/s. One object (33334) has no
// state.
TEST_P(Sgp4Verification, PublishedStatesToTheirPrintedDigits) {
  const std::string tle = test::data_path("sgp4/SGP4-VER.TLE");
  const std::string published = test::data_path("sgp4/tcppver.out");
  DMISE_NEEDS_FILE(tle);
  DMISE_NEEDS_FILE(published);
  const std::vector<MeanElements> elements = test::elements_from_text(read_text_file(tle));
  ASSERT_EQ(elements.size(), 33u);
  const Sgp4Batch batch(elements, nullptr, GetParam());

  std::istringstream lines(read_text_file(published));
  std::string line;
  std::size_t object = std::size_t(-1);
  int states = 0;
  double worst_km = 0.0, worst_km_s = 0.0;
  while (std::getline(lines, line)) {
    std::istringstream fields(line);
    if (line.find("xx") != std::string::npos) {
      std::uint32_t number;
      ASSERT_TRUE(fields >> number);
      ++object;
      ASSERT_EQ(elements[object].catalogue_number, number);
      continue;
    }
    double t, r[3], v[3];
    if (!(fields >> t >> r[0] >> r[1] >> r[2] >> v[0] >> v[1] >> v[2])) continue;
    ++states;
    const Sgp4State s = batch.propagate_one(object, t);
    if (elements[object].catalogue_number == 33334) {
      EXPECT_EQ(s.code, Sgp4Code::perturbed_eccentricity);
      continue;
    }
    EXPECT_EQ(s.code, Sgp4Code::ok) << line;
    worst_km = std::max(worst_km, distance_km(s, r));
    worst_km_s = std::max(worst_km_s, speed_km_s(s, v));
  }
  EXPECT_EQ(states, 667);  // 666 and the one without
  EXPECT_LE(worst_km, 1e-6);
  EXPECT_LE(worst_km_s, 1e-9);
}

// Reference: the 2019-12-19 catalogue by python-sgp4 2.15 at JD 2458837.5, printed to 1e-8 km:
// 18,451 states, 17 with code 1, 2 with code 6.
TEST_P(Sgp4Verification, CatalogueOf18470ObjectsAtOneInstant) {
  const std::string tle = test::data_path("tle/catalog_3le_2019-12-19_18470.txt.gz");
  const std::string published =
      test::data_path("sgp4/ref_states_catalog_3le_2019-12-19_18470_jd2458837.5.csv.gz");
  DMISE_NEEDS_FILE(tle);
  DMISE_NEEDS_FILE(published);
  const std::vector<MeanElements> elements = test::elements_from_text(read_text_file(tle));
  ASSERT_EQ(elements.size(), 18470u);
  const Sgp4Batch batch(elements, nullptr, GetParam());
  const std::size_t n = batch.size();
  std::vector<double> r(3 * n), v(3 * n);
  std::vector<std::uint8_t> code(n);
  batch.propagate(2458837.5, 0.0, r, v, code);

  std::istringstream lines(read_text_file(published));
  std::string line;
  std::getline(lines, line);
  std::map<int, int> codes;
  std::size_t i = 0;
  int mismatches = 0;
  double worst_km = 0.0, worst_km_s = 0.0;
  for (; std::getline(lines, line); ++i) {
    unsigned number;
    int error;
    double p[3], q[3];
    const int got = std::sscanf(line.c_str(), "%u,%d,%lf,%lf,%lf,%lf,%lf,%lf", &number, &error, p,
                                p + 1, p + 2, q, q + 1, q + 2);
    ASSERT_GE(got, 2) << line;
    ASSERT_LT(i, n);
    ASSERT_EQ(number, elements[i].catalogue_number);
    ++codes[code[i]];
    mismatches += code[i] != error;
    if (error != 0 || code[i] != 0) continue;
    const Sgp4State s{{r[i], r[i + n], r[i + 2 * n]}, {v[i], v[i + n], v[i + 2 * n]}};
    worst_km = std::max(worst_km, distance_km(s, p));
    worst_km_s = std::max(worst_km_s, speed_km_s(s, q));
  }
  EXPECT_EQ(i, n);
  EXPECT_EQ(mismatches, 0);
  EXPECT_EQ(codes, (std::map<int, int>{{0, 18451}, {1, 17}, {6, 2}}));
  EXPECT_LE(worst_km, 2e-6);
  EXPECT_LE(worst_km_s, 2e-9);
}

}  // namespace
}  // namespace dmise
