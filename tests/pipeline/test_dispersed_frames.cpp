#include <cmath>
#include <fstream>

#include "core/base/units.h"
#include "core/sky/air/dispersion.h"
#include "tests/pipeline/wiring.h"

namespace dmise {
namespace {

/// Two lines of equal width in one band, or one of them.
std::string band_file(const std::string& name, const std::string& rows) {
  const auto path = std::filesystem::path(testing::TempDir()) / (name + ".csv");
  std::ofstream(path) << "wavelength_nm,transmission\n" << rows;
  return path.string();
}
const std::string blue_line = "449,0\n450,1\n451,0\n", red_line = "749,0\n750,1\n751,0\n";

std::string scene(const std::string& band, const std::string& effects, const std::string& world,
                  const std::string& pointing) {
  std::string camera = test::camera(512, 512, 2.0, "full_well_e: 1.0e+9, gain_e_per_dn: 1",
                                    ", psf: gaussian, psf_fwhm_px: 3");
  camera = camera.substr(0, camera.find("band:")) + "band: {filter: " + band + "}}";
  return test::scenario(
      "2018-01-21T01:30:00Z", 10,
      "site: {latitude_deg: 33.777, longitude_deg: -84.398, height_m: 300}", camera, pointing, 0.01,
      10,
      ", weather: {pressure_hpa: 980, temperature_c: 12, humidity: 0.6}, effects: {" +
          test::noiseless + effects + "}",
      "", world);
}

/// Light, centroid and covariance of counts.
struct Moments {
  double light = 0.0, x = 0.0, y = 0.0, xx = 0.0, xy = 0.0, yy = 0.0;
};

Moments moments(const CountImage& counts) {
  Moments m;
  for (int y = 0; y < counts.rows; ++y)
    for (int x = 0; x < counts.columns; ++x) {
      const double c = counts.at(x, y);
      m.light += c;
      m.x += c * x;
      m.y += c * y;
      m.xx += c * x * x;
      m.xy += c * x * y;
      m.yy += c * y * y;
    }
  m.x /= m.light;
  m.y /= m.light;
  m.xx = m.xx / m.light - m.x * m.x;
  m.xy = m.xy / m.light - m.x * m.y;
  m.yy = m.yy / m.light - m.y * m.y;
  return m;
}

/// A band of two lines has the light of both where frames of each line alone have it: places there
/// are those of ERFA's refraction (StarTrail, tests/reference/wiring.py).
void expect_both_lines(const std::string& world, const std::string& stars,
                       const std::string& pointing, const std::string& integration) {
  const auto frame = [&](const std::string& rows, const std::string& effects) {
    test::Stage stage(scene(band_file("lines", rows), effects + integration, world, pointing),
                      stars);
    return moments(stage.frame().counts);
  };
  const Moments blue = frame(blue_line, ""), red = frame(red_line, "");
  const Moments point = frame(blue_line + red_line, "");
  const Moments both = frame(blue_line + red_line, ", dispersion: on");
  const double dx = red.x - blue.x, dy = red.y - blue.y, length_px = std::hypot(dx, dy);
  ASSERT_GT(length_px, 1.5);
  EXPECT_NEAR(both.light / point.light, 1.0, 1e-4);
  const double share = red.light / (blue.light + red.light);
  EXPECT_NEAR(both.x, std::lerp(blue.x, red.x, share), 0.02);
  EXPECT_NEAR(both.y, std::lerp(blue.y, red.y, share), 0.02);
  const double spread = share * (1 - share);
  EXPECT_NEAR(both.xx - point.xx, spread * dx * dx, 0.04);
  EXPECT_NEAR(both.xy - point.xy, spread * dx * dy, 0.04);
  EXPECT_NEAR(both.yy - point.yy, spread * dy * dy, 0.04);
  const Moments mean = frame(blue_line + red_line, ", dispersion: mean");
  EXPECT_NEAR(mean.x, both.x, 0.01);
  EXPECT_NEAR(mean.y, both.y, 0.01);
  EXPECT_NEAR(mean.yy, point.yy, 0.02);
}

const std::string one_star = "ra_deg,dec_deg,mag_v,bv\n125,10,-9,0.3\n";
const std::string at_star = "{ra_deg: 125, dec_deg: 10}";

TEST(DispersedFrame, AStarIsWhereEachWavelengthAloneHasIt) {
  expect_both_lines(test::with_stars, one_star, at_star, "");
}

TEST(DispersedFrame, SnapshotsAreSpreadAsPathsAre) {
  expect_both_lines(test::with_stars, one_star, at_star, ", integration: snapshots, snapshots: 4");
}

TEST(DispersedFrame, AnObjectIsSpreadAsAStarIs) {
  const std::string pointing = "{azimuth_deg: 130, elevation_deg: 20.04}";
  // Where the camera looks: an object stands there, 900 km away.
  test::Stage empty(scene(band_file("lines", blue_line), "", "", pointing));
  const View view(empty.scenario.sensors[0], frame_times(empty.scenario.sensors[0], 1),
                  empty.states);
  const Vec<Gcrs> at = view.observer(view.times().middle).position_m +
                       test::direction(view, 130 * deg, 20 * deg) * 900e3;
  char text[200];
  std::snprintf(text, sizeof text,
                "objects:\n  - {name: sphere, motion: {fixed: {gcrs_m: [%.3f, %.3f, %.3f]}}, "
                "radius_m: 1000}\n",
                at.x, at.y, at.z);
  expect_both_lines(text, "", pointing, ", shadow: off");
}

TEST(DispersedFrame, IsOffUnlessAskedFor) {
  EXPECT_FALSE(EffectSet().has(Dispersion::facts));
  test::Stage stage(scene(band_file("lines", blue_line), "", test::with_stars, at_star), one_star);
  EXPECT_FALSE(stage.scenario.sensors[0].effects.has(Dispersion::facts));
}

}  // namespace
}  // namespace dmise
