#include <cmath>

#include "core/base/units.h"
#include "tests/pipeline/wiring.h"

namespace dmise {
namespace {

/// Light of each column.
std::vector<double> column_sums(const CountImage& counts) {
  std::vector<double> sums(std::size_t(counts.columns));
  for (int y = 0; y < counts.rows; ++y)
    for (int x = 0; x < counts.columns; ++x) sums[std::size_t(x)] += counts.at(x, y);
  return sums;
}

/// Row of the light in a column.
double row_of(const CountImage& counts, int x) {
  double sum = 0, rows = 0;
  for (int y = 0; y < counts.rows; ++y) {
    sum += counts.at(x, y);
    rows += double(counts.at(x, y)) * y;
  }
  return rows / sum;
}

/// Where a trail along the columns ends near `x`, its inside in the direction `inwards` (1, -1):
/// there the light of a column is half of what it is inside.
PixelPosition end_of(const CountImage& counts, int x, int inwards) {
  const auto sums = column_sums(counts);
  double plateau = 0;
  for (int k = 10; k < 40; ++k) plateau += sums[std::size_t(x + inwards * k)] / 30;
  int at = x + 10 * inwards;
  while (sums[std::size_t(at)] > plateau / 2) at -= inwards;
  const double out = sums[std::size_t(at)], in = sums[std::size_t(at + inwards)];
  const double x_px = at + inwards * (plateau / 2 - out) / (in - out);
  const double near = row_of(counts, x + 10 * inwards), far = row_of(counts, x + 30 * inwards);
  return {x_px, near + (near - far) / 20 * ((x + 10 * inwards) - x_px) * inwards};
}

std::string rising(const std::string& effects) {
  return test::scenario(
      "2018-01-21T00:13:40Z", 600,
      "site: {latitude_deg: 33.777, longitude_deg: -84.398, height_m: 300}",
      test::camera(1000, 128, 0.2),
      "{azimuth_deg: 84.612, elevation_deg: 10.001, roll_deg: -56.949}", 600, 600,
      ", weather: {pressure_hpa: 980, temperature_c: 12, humidity: 0.6}, effects: {" +
          test::noiseless + ", extinction: off" + effects + "}",
      "", test::with_stars);
}
const std::string star = "ra_deg,dec_deg,mag_v,bv\n125,10,4,0.65\n";

// A star rises through 10 deg while a fixed camera looks for ten minutes; its trail lies along the
// columns. Reference: the observed places of ERFA's eraAtco13 (astropy's) at the exposure's ends,
// by tests/reference/wiring.py.
TEST(StarTrail, EndsWhereTheStarIsObservedAtTheEndsOfTheExposure) {
  test::Stage stage(rising(""), star);
  const auto frame = stage.frame();
  const PixelPosition start = end_of(frame.counts, 71, 1), end = end_of(frame.counts, 928, -1);
  constexpr double tolerance_px = 0.3;  // 3 arcsec: eraRefco against Bennett at 9 deg
  EXPECT_NEAR(start.x_px, 71.066, tolerance_px);
  EXPECT_NEAR(start.y_px, 62.728, tolerance_px);
  EXPECT_NEAR(end.x_px, 928.189, tolerance_px);
  EXPECT_NEAR(end.y_px, 62.673, tolerance_px);
}

// One snapshot is the scene of mid exposure.
TEST(StarTrail, ASnapshotIsOfTheMiddleOfItsPart) {
  test::Stage stage(rising(", integration: snapshots, snapshots: 1"), star);
  const auto at = test::centroid(stage.frame().counts, {499, 64}, 40);
  EXPECT_NEAR(at.x_px, 499.417, 0.3);
  EXPECT_NEAR(at.y_px, 63.653, 0.3);
}

}  // namespace
}  // namespace dmise
