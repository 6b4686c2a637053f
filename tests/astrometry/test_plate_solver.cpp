#include "core/astrometry/plate_solver.h"

#include <gtest/gtest.h>
#include <chrono>
#include <cstdio>

#include "core/base/error.h"
#include "core/base/units.h"
#include "tests/astrometry/seen_plate.h"

namespace dmise {
namespace {

using test::PlateCase;
using test::SeenPlate;

class BlindPlate : public ::testing::TestWithParam<PlateCase> {};

TEST_P(BlindPlate, IsSolvedWithoutPointingAndScale) {
  DMISE_NEEDS_FILE(test::catalogue_path("stars.dat"));
  const PlateSky sky = test::sky_of(test::kstars());
  const SeenPlate p = test::seen_plate(sky, GetParam(), 400, 0.1, 7, GetParam().width_deg < 4 ? 2 : 40);
  auto t0 = std::chrono::steady_clock::now();
  try {
  const PlateSolution s = solve_plate(p.sources, p.belief, sky);
  double dt = std::chrono::duration<double>(std::chrono::steady_clock::now()-t0).count();
  std::printf("%s %g: %zu sources, %d used, rms %.3f diff %.3f odds %.0f tried %zu free f%d c%d o%d  %.3f s\n", GetParam().projection.c_str(), GetParam().width_deg, p.sources.size(), s.fit.count, s.fit.rms_px, test::difference_px(p.truth, s.fit.model, p.belief.columns, p.belief.rows), s.log_odds, s.tried, s.fit.free.focal_length, s.fit.free.centre, s.fit.free.order, dt);
  } catch (const Error& e) {
  double dt = std::chrono::duration<double>(std::chrono::steady_clock::now()-t0).count();
  std::printf("%s %g: %zu sources: %s %.3f s\n", GetParam().projection.c_str(), GetParam().width_deg, p.sources.size(), e.what(), dt);
  ADD_FAILURE();
  }
}

class NearPlate : public ::testing::TestWithParam<PlateCase> {};

TEST_P(NearPlate, IsSolved) {
  DMISE_NEEDS_FILE(test::catalogue_path("stars.dat"));
  const PlateSky sky = test::sky_of(test::kstars());
  SeenPlate p = test::seen_plate(sky, GetParam(), 400, 0.1, 7, GetParam().width_deg < 4 ? 2 : 40);
  const PlateCase c = GetParam();
  p.belief.focal_length_px = p.truth.focal_length_px * 1.02;
  p.belief.camera_from_gcrs = turned(p.truth.camera_from_gcrs, {1.5 * deg, -1.3 * deg, 5 * deg});
  auto t0 = std::chrono::steady_clock::now();
  try {
  const PlateSolution s = solve_plate(p.sources, p.belief, sky);
  double dt = std::chrono::duration<double>(std::chrono::steady_clock::now()-t0).count();
  std::printf("NEAR %s %g: %zu sources, %d used, rms %.3f diff %.3f odds %.0f tried %zu free f%d c%d o%d  %.3f s\n", GetParam().projection.c_str(), GetParam().width_deg, p.sources.size(), s.fit.count, s.fit.rms_px, test::difference_px(p.truth, s.fit.model, p.belief.columns, p.belief.rows), s.log_odds, s.tried, s.fit.free.focal_length, s.fit.free.centre, s.fit.free.order, dt);
  } catch (const Error& e) {
  double dt = std::chrono::duration<double>(std::chrono::steady_clock::now()-t0).count();
  std::printf("NEAR %s %g: %zu sources: %s %.3f s\n", GetParam().projection.c_str(), GetParam().width_deg, p.sources.size(), e.what(), dt);
  ADD_FAILURE();
  }
}
const auto fields = ::testing::Values(
  PlateCase{"gnomonic", 1, 83, 22},PlateCase{"gnomonic", 1, 283, 5},PlateCase{"gnomonic", 1.5, 83, 22},PlateCase{"gnomonic", 2, 83, 22}, PlateCase{"gnomonic", 3, 283, 5}, PlateCase{"gnomonic", 5, 0.01, 30}, PlateCase{"gnomonic", 10, 190, 89.5}, PlateCase{"gnomonic", 20},
  PlateCase{"gnomonic", 40}, PlateCase{"gnomonic", 60, 200, -70}, PlateCase{"gnomonic", 90, 20, 40},
  PlateCase{"equidistant", 5}, PlateCase{"equidistant", 20}, PlateCase{"equidistant", 60}, PlateCase{"equidistant", 90}, PlateCase{"equisolid", 150}, PlateCase{"stereographic", 90});
INSTANTIATE_TEST_SUITE_P(Fields, NearPlate, fields);
INSTANTIATE_TEST_SUITE_P(Fields, BlindPlate, ::testing::Values(
  PlateCase{"gnomonic", 1, 83, 22},PlateCase{"gnomonic", 1, 283, 5},PlateCase{"gnomonic", 1.5, 83, 22},PlateCase{"gnomonic", 2, 83, 22}, PlateCase{"gnomonic", 3, 283, 5}, PlateCase{"gnomonic", 5, 0.01, 30}, PlateCase{"gnomonic", 10, 190, 89.5}, PlateCase{"gnomonic", 20},
  PlateCase{"gnomonic", 40}, PlateCase{"gnomonic", 60, 200, -70}, PlateCase{"gnomonic", 90, 20, 40},
  PlateCase{"equidistant", 5}, PlateCase{"equidistant", 20}, PlateCase{"equidistant", 60}, PlateCase{"equidistant", 90}, PlateCase{"equisolid", 90}, PlateCase{"stereographic", 90}));

}  // namespace
}  // namespace dmise
