#include <cmath>

#include "sensors/scene/bodies_in_field.h"
#include "tests/pipeline/body_scenes.h"

// Discs of Sun, Moon and Earth behind a rolling shutter.
namespace dmise::test {
namespace {

constexpr int side = 200;
constexpr double row_us = 1000.0, exposure_s = 0.001;

/// A camera that stands in space and turns; `along`: 0 moves the image along rows, 1 along columns.
struct Turning {
  Vec<Gcrs> at_m, boresight;
  double pixel_rad = 1e-4, px_per_s = 0.0;
  int along = 0;
  double row_time_us = row_us;
  int rows = side;
  double turned_before_s = 0.0;

  std::string yaml() const {
    const Vec<Gcrs> east = unit(cross(Vec<Gcrs>{0, 0, 1}, boresight));
    const Vec<Gcrs> axis = along == 0 ? cross(boresight, east) : east;
    const double rate_rad_per_s = px_per_s * pixel_rad, back = -rate_rad_per_s * turned_before_s;
    const Vec<Gcrs> start = boresight * std::cos(back) + cross(axis, boresight) * std::sin(back);
    char text[300], platform[160];
    std::snprintf(text, sizeof text,
                  "{scan: {%s, axis: [%.12f, %.12f, %.12f], rate_deg_per_s: %.9f}}",
                  towards(start).substr(1, towards(start).size() - 2).c_str(), axis.x, axis.y,
                  axis.z, rate_rad_per_s / deg);
    std::snprintf(platform, sizeof platform,
                  "objects:\n  - name: platform\n    motion: {fixed: {gcrs_m: [%.3f, %.3f, "
                  "%.3f]}}\n",
                  at_m.x, at_m.y, at_m.z);
    const std::string detector =
        "full_well_e: 1.0e+9, gain_e_per_dn: 1, row_time_us: " + std::to_string(row_time_us);
    return scenario("2018-01-21T00:15:00Z", 5, "platform: platform",
                    camera(side, rows, 1e-5 / pixel_rad, detector, ", aperture_m: 0.002"), text,
                    exposure_s, 5, more(), "", platform);
  }
};

/// Where the Sun is seen in full, and the full Earth as well.
Vec<Gcrs> sunward_m() { return unit(bodies().sun_m) * 4e7; }
Vec<Gcrs> sun_from(const Vec<Gcrs>& at_m) { return unit(bodies().sun_m - at_m); }

struct Moments {
  double sum = 0, x = 0, y = 0, rms_x = 0, rms_y = 0;
};
Moments moments_of(const ExpectedElectronImage& image, int first_row, int last_row) {
  Moments m;
  double xx = 0, yy = 0;
  for (int y = first_row; y <= last_row; ++y)
    for (int x = 0; x < image.columns; ++x) {
      const double e = image.at(x, y);
      m.sum += e;
      m.x += e * x;
      m.y += e * y;
      xx += e * x * x;
      yy += e * y * y;
    }
  m.x /= m.sum;
  m.y /= m.sum;
  m.rms_x = std::sqrt(xx / m.sum - m.x * m.x);
  m.rms_y = std::sqrt(yy / m.sum - m.y * m.y);
  return m;
}
Moments moments_of(const ExpectedElectronImage& image) {
  return moments_of(image, 0, image.rows - 1);
}

/// Least squares over rows about the middle: pixels along the row for each row.
double shear_of(const ExpectedElectronImage& image, int half_rows) {
  double sy = 0, sx = 0, syy = 0, sxy = 0, n = 0;
  for (int y = side / 2 - half_rows; y <= side / 2 + half_rows; ++y) {
    const double x = moments_of(image, y, y).x;
    n += 1, sy += y, sx += x, syy += double(y) * y, sxy += y * x;
  }
  return (n * sxy - sx * sy) / (n * syy - sy * sy);
}

// A disc that moves along rows by v px/s is sheared by v times the row time; each row's centroid is
// where the disc is in the middle of the row's own exposure.
TEST(RolledDisc, OfTheSunIsShearedByItsRateTimesTheRowTime) {
  for (const double px_per_s : {-100.0, 2.0, 100.0, 700.0}) {
    const int half_rows = std::abs(px_per_s) > 500 ? 20 : 35;
    Stage stage(Turning{.at_m = sunward_m(),
                        .boresight = sun_from(sunward_m()),
                        .px_per_s = px_per_s,
                        .turned_before_s = 0.1}
                    .yaml());
    const auto& sensor = stage.scenario.sensors[0];
    const View view(sensor, frame_times(sensor, 1), stage.states);
    const auto image = light_of(stage);
    EXPECT_NEAR(std::abs(shear_of(image, half_rows)), std::abs(px_per_s) * row_us * 1e-6,
                1e-4 + 2e-3 * std::abs(px_per_s) * row_us * 1e-6)
        << px_per_s;
    for (const int y : {70, 100, 130}) {
      const SimTime t = view.times().middle + sim_seconds(y * row_us * 1e-6);
      const auto sun = pixel_of(view, seen_sun(view, t).apparent, t);
      EXPECT_NEAR(moments_of(image, y, y).x, sun->x_px, 0.05) << px_per_s << " " << y;
    }
  }
}

TEST(RolledDisc, OfTheEarthIsShearedAsWell) {
  Stage stage(Turning{.at_m = sunward_m(),
                      .boresight = unit(sunward_m()) * -1.0,
                      .pixel_rad = 2e-3,
                      .px_per_s = 100.0,
                      .turned_before_s = 0.1}
                  .yaml());
  EXPECT_NEAR(std::abs(shear_of(light_of(stage), 50)), 0.1, 1e-3);
}

// By how much more than the same Moon before a camera that stands still.
TEST(RolledDisc, OfTheMoonIsShearedAsWell) {
  const Vec<Gcrs> at_m = sunward_m(), moon = unit(bodies().moon_m - at_m);
  Turning turning{.at_m = at_m, .boresight = moon, .px_per_s = 100.0, .turned_before_s = 0.1};
  Stage turns(turning.yaml());
  turning.px_per_s = 0.0;
  Stage stands(turning.yaml());
  turning.row_time_us = 0.0;
  Stage at_once(turning.yaml());
  const auto image = light_of(turns), still = light_of(stands), all_rows = light_of(at_once);
  EXPECT_NEAR(std::abs(shear_of(image, 30) - shear_of(still, 30)), 0.1, 1e-3);
  // The Moon's own way in 0.2 s is 0.006 px.
  EXPECT_NEAR(sum_of(still) / sum_of(all_rows), 1.0, 1e-3);
  EXPECT_NEAR(moments_of(still).x, moments_of(all_rows).x, 0.02);
  EXPECT_NEAR(moments_of(still).y, moments_of(all_rows).y, 0.02);
}

// Along columns y = y0 + v t with t = y times the row time: higher by 1 / (1 - v), v the rows that
// it moves in a row time.
TEST(RolledDisc, ThatMovesAlongColumnsIsHigherByOneOverOneLessItsSpeed) {
  for (const double px_per_s : {-200.0, 100.0}) {
    Turning turning{.at_m = sunward_m(),
                    .boresight = sun_from(sunward_m()),
                    .px_per_s = px_per_s,
                    .along = 1,
                    .turned_before_s = 0.1};
    Stage stage(turning.yaml());
    const auto& sensor = stage.scenario.sensors[0];
    const View view(sensor, frame_times(sensor, 1), stage.states);
    const SimTime t = view.times().middle, later = t + sim_seconds(0.1);
    const double speed_px_per_s = (pixel_of(view, seen_sun(view, later).apparent, later)->y_px -
                                   pixel_of(view, seen_sun(view, t).apparent, t)->y_px) /
                                  0.1;
    EXPECT_NEAR(std::abs(speed_px_per_s), std::abs(px_per_s), 0.5);
    turning.px_per_s = 0.0;
    Stage at_rest(turning.yaml());
    const Moments m = moments_of(light_of(stage)), still = moments_of(light_of(at_rest));
    const double higher = 1.0 / (1.0 - speed_px_per_s * row_us * 1e-6);
    EXPECT_NEAR(m.sum / still.sum, higher, 3e-3 * higher) << px_per_s;
    EXPECT_NEAR(m.rms_y / still.rms_y, higher, 3e-3 * higher) << px_per_s;
    EXPECT_NEAR(m.rms_x / still.rms_x, 1.0, 3e-3) << px_per_s;
  }
}

// The first rows are exposed while it is beyond the margin; the last ones when it is in the field.
TEST(RolledDisc, ComesIntoTheFieldWhileLaterRowsAreExposed) {
  Stage stage(Turning{.at_m = sunward_m(),
                      .boresight = sun_from(sunward_m()),
                      .px_per_s = 1500.0,
                      .turned_before_s = 0.2}
                  .yaml());
  const auto& sensor = stage.scenario.sensors[0];
  const View view(sensor, frame_times(sensor, 1), stage.states);
  const SimTime first = view.times().middle, last = first + sim_seconds(0.199);
  const auto from_middle_px = [&](SimTime t) {
    return std::abs(pixel_of(view, seen_sun(view, t).apparent, t)->x_px - 0.5 * (side - 1));
  };
  EXPECT_GT(from_middle_px(first), 0.5 * side + 48 + disc_margin_px);
  EXPECT_LT(from_middle_px(last), 5.0);
  const auto image = light_of(stage);
  expect_finite(image);
  EXPECT_GT(sum_of(image), 0.0);
}

TEST(RolledDisc, OfOneRowIsThatOfAllRowsAtOnce) {
  for (const Vec<Gcrs>& towards_it : {sun_from(sunward_m()), unit(sunward_m()) * -1.0}) {
    Turning turning{
        .at_m = sunward_m(), .boresight = towards_it, .px_per_s = 3000.0, .along = 1, .rows = 1};
    Stage rolled(turning.yaml());
    turning.row_time_us = 0.0;
    Stage at_once(turning.yaml());
    const auto image = light_of(rolled);
    EXPECT_EQ(image.pixels, light_of(at_once).pixels);
    EXPECT_GT(sum_of(image), 0.0);
  }
}

TEST(RolledDisc, IsTheSameForAnyNumberOfThreads) {
  Stage stage(Turning{.at_m = sunward_m(),
                      .boresight = sun_from(sunward_m()),
                      .px_per_s = 100.0,
                      .turned_before_s = 0.1}
                  .yaml());
  const auto one = light_of(stage);
  for (const int n : {2, 5}) {
    Threads threads(n);
    EXPECT_EQ(light_of(stage, threads).pixels, one.pixels) << n;
  }
}

}  // namespace
}  // namespace dmise::test
