#include "core/detection/detect.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/products/product_json.h"
#include "core/wcs/wcs.h"
#include "tests/support/simulated_frame.h"

namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;

constexpr double all_sky_focal_px = 1663.0;
constexpr double declination = 34 * deg;
constexpr double sky_e = 1500.0;

struct Placed {
  double x, y;
};

/// Matched-filter SNR of a source of `flux_e` spread like `footprint` squares: flux / noise of the
/// fit.
double noise_e(const FrameHeader& h) {
  return std::sqrt(sky_e + h.read_noise_e * h.read_noise_e +
                   h.gain_e_per_dn * h.gain_e_per_dn / 12);
}

const Detection* nearest(const std::vector<Detection>& detections, const Placed& place,
                         double within) {
  const Detection* best = nullptr;
  for (const Detection& d : detections) {
    const double distance = std::hypot(d.x_px - place.x, d.y_px - place.y);
    if (distance < within) {
      within = distance;
      best = &d;
    }
  }
  return best;
}

struct Errors {
  int found = 0;
  double mean_x = 0, mean_y = 0, rms = 0, nees = 0, mean_flux = 0;
};

/// Sources on a grid against what was detected.
Errors errors_of(const std::vector<Detection>& detections, const std::vector<Placed>& places,
                 double flux_e) {
  Errors e;
  for (const Placed& place : places) {
    const Detection* d = nearest(detections, place, 3.0);
    if (!d) continue;
    const double dx = d->x_px - place.x, dy = d->y_px - place.y;
    const auto [xx, xy, yy] = d->covariance_px2;
    ++e.found;
    e.mean_x += dx;
    e.mean_y += dy;
    e.rms += dx * dx + dy * dy;
    e.nees += (dx * dx * yy - 2 * dx * dy * xy + dy * dy * xx) / (xx * yy - xy * xy) / 2;
    e.mean_flux += d->signal_e / flux_e;
  }
  const double n = std::max(e.found, 1);
  return {e.found, e.mean_x / n, e.mean_y / n, std::sqrt(e.rms / n), e.nees / n, e.mean_flux / n};
}

/// Squared error of end 1 by its own covariance, against where the pixel `truth` is in the sky.
double nees_on_the_sky(const Detection& d, const Wcs& wcs, PixelPosition truth) {
  const auto place = to_spherical(wcs_direction(wcs, truth));
  const double e = std::remainder(d.end1_ra_rad - place[0], 2 * pi) * std::cos(place[1]);
  const double n = d.end1_dec_rad - place[1];
  const auto [ee, en, nn] = d.end1_covariance_rad2;
  return (e * e * nn - 2 * e * n * en + n * n * ee) / (ee * nn - en * en);
}

TEST(Detect, PointsAmongTrailedStarsAreUnbiasedAndTheirCovarianceHonest) {
  const auto header = camera_header(1000, 1000, all_sky_focal_px, declination, 20, true);
  SimulatedFrame frame(header, 1000, 1000, sky_e, 7);
  std::vector<Placed> places;
  const double flux_e = 8000.0;  // SNR 60
  for (int j = 0; j < 30; ++j)
    for (int i = 0; i < 30; ++i) {
      places.push_back(
          {30 + 32 * i + frame.uniform(-.5, .5), 30 + 32 * j + frame.uniform(-.5, .5)});
      frame.add_point(places.back().x, places.back().y, flux_e);
    }
  Threads threads;
  const auto result = detect(frame.expose(), header, {}, threads);
  const Errors e = errors_of(result.detections, places, flux_e);
  EXPECT_GE(e.found, 890);
  EXPECT_LT(e.rms, 0.05);
  EXPECT_NEAR(e.mean_x, 0.0, 4 * 0.02 / 30);
  EXPECT_NEAR(e.mean_y, 0.0, 4 * 0.02 / 30);
  EXPECT_GT(e.nees, 0.9);
  EXPECT_LT(e.nees, 1.1);
  EXPECT_NEAR(e.mean_flux, 1.0, 0.01);
  for (const Detection& d : result.detections) EXPECT_EQ(d.kind, DetectionKind::point);
}

TEST(Detect, StreaksAreUnbiasedAndTheirCovarianceHonest) {
  const auto header = camera_header(2000, 2000, all_sky_focal_px, declination, 20, true);
  SimulatedFrame frame(header, 2000, 2000, sky_e, 8);
  std::vector<Placed> places;
  std::vector<double> lengths, angles;
  const double e_per_px = 400.0;
  for (int j = 0; j < 20; ++j)
    for (int i = 0; i < 20; ++i) {
      places.push_back(
          {60 + 98 * i + frame.uniform(-.5, .5), 60 + 98 * j + frame.uniform(-.5, .5)});
      lengths.push_back(frame.uniform(15, 80));
      angles.push_back(frame.uniform(0, pi));
      frame.add_streak(places.back().x, places.back().y, lengths.back(), angles.back(),
                       e_per_px * lengths.back());
    }
  Threads threads;
  const auto result = detect(frame.expose(), header, {}, threads);
  const Errors e = errors_of(result.detections, places, 1.0);
  EXPECT_GE(e.found, 396);
  EXPECT_NEAR(e.mean_x, 0.0, 0.03);
  EXPECT_NEAR(e.mean_y, 0.0, 0.03);
  EXPECT_GT(e.nees, 0.9);
  EXPECT_LT(e.nees, 1.1);
  double length_error = 0, density = 0, end_nees = 0;
  int n = 0;
  for (std::size_t i = 0; i < places.size(); ++i)
    if (const Detection* d = nearest(result.detections, places[i], 3.0)) {
      length_error += d->length_px - lengths[i];
      density += d->signal_e / lengths[i] / e_per_px;
      const double c = std::cos(angles[i]) >= 0 ? 1 : -1;  // end 1 is the left one
      const PixelPosition end = {places[i].x - c * lengths[i] / 2 * std::cos(angles[i]),
                                 places[i].y - c * lengths[i] / 2 * std::sin(angles[i])};
      end_nees += nees_on_the_sky(*d, header.wcs, end) / 2;
      ++n;
    }
  EXPECT_NEAR(length_error / n, 0.0, 0.1);
  EXPECT_GT(end_nees / n, 0.85);
  EXPECT_LT(end_nees / n, 1.15);
  EXPECT_NEAR(density / n, 1.0, 0.01);
}

/// Mean square of the errors of long streaks' centroids along themselves, over their variances.
struct AlongItself {
  int drawn = 0, found = 0;
  double ratio2 = 0.0;
};

AlongItself errors_along(double e_per_px, double length_px, unsigned seed) {
  constexpr int columns = 1600, rows = 1000;
  AlongItself all;
  for (unsigned frames = 0; all.drawn < 60; ++frames) {
    const auto header = camera_header(columns, rows, all_sky_focal_px, declination, 0.1, false);
    SimulatedFrame frame(header, columns, rows, sky_e, seed + frames);
    std::vector<Placed> places;
    std::vector<double> angles;
    for (int row = 0; row < 5; ++row)
      for (double x = 0.7 * length_px; x + 0.7 * length_px < columns; x += 1.4 * length_px) {
        places.push_back({x + frame.uniform(-.5, .5), 100 + 200 * row + frame.uniform(-.5, .5)});
        angles.push_back(frame.uniform(-0.1, 0.1));
        const double own_px = frame.uniform(0.8, 1.2) * length_px;
        frame.add_streak(places.back().x, places.back().y, own_px, angles.back(),
                         e_per_px * own_px);
      }
    Threads threads(2);
    const auto result = detect(frame.expose(), header, {}, threads);
    for (std::size_t i = 0; i < places.size(); ++i) {
      ++all.drawn;
      const Detection* d = nearest(result.detections, places[i], 12.0);
      if (!d) continue;
      const double c = std::cos(angles[i]), s = std::sin(angles[i]);
      const double along = (d->x_px - places[i].x) * c + (d->y_px - places[i].y) * s;
      const auto [xx, xy, yy] = d->covariance_px2;
      all.ratio2 += along * along / (xx * c * c + 2 * xy * c * s + yy * s * s);
      ++all.found;
    }
  }
  all.ratio2 /= std::max(all.found, 1);
  return all;
}

// 60 straight streaks each: the mean square of normal errors is known to 0.18.
TEST(Detect, LongStreaksErrorsAlongThemselvesAreAsStated) {
  unsigned seed = 300;
  for (const double e_per_px : {150.0, 1000.0}) {
    const AlongItself all = errors_along(e_per_px, 400.0, seed += 20);
    EXPECT_GE(all.found, all.drawn - 1) << e_per_px;
    EXPECT_LT(all.ratio2, 1.0 + 3 * 0.18) << e_per_px;
  }
}

// The all-sky camera of 3326 x 2504 pixels, 15,000 trailed stars, nothing else.
TEST(Detect, CrowdedStarFieldGivesLessThanOneFalseDetectionPerFrame) {
  int published = 0;
  std::uint32_t stars = 0;
  for (unsigned seed = 1; seed <= 3; ++seed) {
    const auto header = camera_header(3326, 2504, all_sky_focal_px, declination, 20, true);
    SimulatedFrame frame(header, 3326, 2504, sky_e, seed);
    frame.add_stars(15000, 500, 3e6);
    Threads threads(2);
    const auto result = detect(frame.expose(), header, {}, threads);
    published += int(result.detections.size());
    stars += result.report.star_like;
  }
  EXPECT_LE(published, 2);
  EXPECT_GT(stars, 3 * 9000u);
}

TEST(Detect, SiderealFrameOfStarsGivesNothing) {
  const auto header = camera_header(1500, 1500, 20000, declination, 5, false);
  SimulatedFrame frame(header, 1500, 1500, sky_e, 3);
  frame.add_stars(4000, 500, 3e6);
  Threads threads;
  const auto result = detect(frame.expose(), header, {}, threads);
  EXPECT_LE(result.detections.size(), 1u);
  EXPECT_GT(result.report.star_like, 2500u);
}

/// Long streaks whose pixels reach `peak_snr` at best, over a crowded field.
std::pair<int, int> long_streaks_found(double peak_snr, unsigned seed) {
  const auto header = camera_header(3326, 2504, all_sky_focal_px, declination, 20, true);
  SimulatedFrame frame(header, 3326, 2504, sky_e, seed);
  frame.add_stars(15000, 500, 3e6);
  const double sigma =
      std::sqrt(std::pow(header.psf_fwhm_px / std::sqrt(8 * std::log(2)), 2) + 1. / 12);
  std::vector<Placed> places;
  for (int i = 0; i < 12; ++i) {  // apart from each other
    const int column = i % 4, row = i / 4;
    places.push_back({400.0 + 800 * column, 420.0 + 820 * row});
    const double length = frame.uniform(200, 600);
    frame.add_streak(places.back().x, places.back().y, length, frame.uniform(0, pi),
                     peak_snr * noise_e(header) * sigma * std::sqrt(2 * pi) * length, 0.1, 1.0);
  }
  Threads threads(2);
  const auto result = detect(frame.expose(), header, {}, threads);
  int found = 0;
  for (const Placed& place : places) found += nearest(result.detections, place, 15.0) != nullptr;
  return {found, int(result.detections.size()) - found};
}

TEST(Detect, FindsLongFaintStreaksWhole) {
  const auto [found, other] = long_streaks_found(3.0, 21);
  EXPECT_EQ(found, 12);
  EXPECT_LE(other, 1);
}

TEST(Detect, FindsLongBrightStreaksWhole) {
  const auto [found, other] = long_streaks_found(100.0, 22);
  EXPECT_EQ(found, 12);
  EXPECT_LE(other, 1);
}

TEST(Detect, CrossingStreaksAreToldApart) {
  const auto header = camera_header(600, 600, all_sky_focal_px, declination, 20, true);
  SimulatedFrame frame(header, 600, 600, sky_e, 4);
  frame.add_streak(300, 300, 300, 0.4, 300 * 500.0);
  frame.add_streak(310, 290, 250, 1.7, 250 * 400.0);
  Threads threads;
  const auto result = detect(frame.expose(), header, {}, threads);
  ASSERT_EQ(result.detections.size(), 2u);
  EXPECT_NEAR(result.detections[0].length_px, 300, 3);
  EXPECT_NEAR(result.detections[1].length_px, 250, 3);
}

TEST(Detect, ResultsDoNotDependOnThreads) {
  const auto header = camera_header(1200, 900, all_sky_focal_px, declination, 20, true);
  SimulatedFrame frame(header, 1200, 900, sky_e, 5);
  frame.add_stars(1500, 500, 3e6);
  for (int i = 0; i < 6; ++i) frame.add_streak(150 + 150 * i, 450, 90, 0.3 * i, 90 * 300.0);
  for (int i = 0; i < 6; ++i) frame.add_point(120 + 150 * i, 150, 9000);
  const CountImage counts = frame.expose();
  Threads one(1), four(4);
  const auto a = detect(counts, header, {}, one), b = detect(counts, header, {}, four);
  EXPECT_EQ(a.detections, b.detections);
  EXPECT_EQ(a.report, b.report);
  EXPECT_GE(a.detections.size(), 10u);
}

TEST(Detect, StreakCutByTheEdgeIsFlagged) {
  const auto header = camera_header(500, 500, all_sky_focal_px, declination, 20, true);
  SimulatedFrame frame(header, 500, 500, sky_e, 6);
  frame.add_streak(20, 250, 200, 0.1, 200 * 500.0);   // leaves at x = 0
  frame.add_streak(300, 250, 100, 1.2, 100 * 600.0);  // whole
  Threads threads;
  const auto result = detect(frame.expose(), header, {}, threads);
  ASSERT_EQ(result.detections.size(), 2u);
  for (const Detection& d : result.detections) EXPECT_EQ(d.at_edge, d.x_px < 150) << d.x_px;
}

TEST(Detect, SaturatedStreakIsFlagged) {
  auto header = camera_header(400, 400, all_sky_focal_px, declination, 20, true);
  SimulatedFrame frame(header, 400, 400, sky_e, 9);
  frame.add_streak(200, 200, 150, 0.7, 150 * 150000.0);
  Threads threads;
  const auto result = detect(frame.expose(), header, {}, threads);
  ASSERT_EQ(result.detections.size(), 1u);
  EXPECT_TRUE(result.detections[0].saturated);
  EXPECT_GT(result.report.saturated_px, 100u);
}

TEST(Detect, EmptyAndTinyAndFlatFramesGiveAReport) {
  Threads threads;
  for (const auto& [columns, rows] : {std::pair{1, 1}, {1, 50}, {50, 1}, {7, 5}, {300, 200}}) {
    const auto header = camera_header(columns, rows, all_sky_focal_px, declination, 20, true);
    SimulatedFrame frame(header, columns, rows, sky_e, 1);
    const auto noisy = detect(frame.expose(), header, {}, threads);
    EXPECT_EQ(noisy.report.detections, 0u);
    for (const std::uint16_t level : {0, 100, 65535}) {
      const auto flat = detect(CountImage(columns, rows, level), header, {}, threads);
      EXPECT_TRUE(flat.detections.empty());
      EXPECT_NO_THROW(to_json(flat.report, [](SimTime) { return ""; }));
    }
  }
}

// m = zero point - 2.5 log10(electrons per second).
TEST(Detect, MagnitudeFollowsFromTheZeroPoint) {
  const auto header = camera_header(400, 400, all_sky_focal_px, declination, 20, true);
  SimulatedFrame frame(header, 400, 400, sky_e, 10);
  frame.add_streak(200, 200, 60, 0.7, 60000.0);
  Threads threads;
  const auto result = detect(frame.expose(), header, {}, threads);
  ASSERT_EQ(result.detections.size(), 1u);
  const Detection& d = result.detections[0];
  EXPECT_NEAR(d.magnitude, 17.0 - 2.5 * std::log10(60000.0 / 20), 4 * d.magnitude_sigma);
  EXPECT_LT(d.magnitude_sigma, 0.03);
  // dm = 2.5 / ln 10 dF / F.
  EXPECT_NEAR(d.magnitude_sigma * d.snr, 1.0857362047581294, 1e-12);
  EXPECT_EQ(d.end1_time, header.start);
  EXPECT_EQ(d.end2_time, header.end);
  EXPECT_NEAR(d.rate_rad_per_s, 60 / all_sky_focal_px / 20, 0.02 * 60 / all_sky_focal_px / 20);
}

// By hand: columns run north and rows west, so that a line at the angle a from +x towards +y has
// the position angle -a from north through east. End 1 is the one with smaller x.
TEST(Detect, PositionAngleIsFromNorthThroughEast) {
  const auto header = camera_header(400, 400, all_sky_focal_px, declination, 20, true);
  Threads threads;
  for (const double angle : {0.7, -0.7, 1.4}) {
    SimulatedFrame frame(header, 400, 400, sky_e, 10);
    frame.add_streak(200, 200, 60, angle, 60000.0);
    const auto result = detect(frame.expose(), header, {}, threads);
    ASSERT_EQ(result.detections.size(), 1u);
    const double expected = angle > 0 ? 2 * pi - angle : -angle;
    EXPECT_NEAR(result.detections[0].position_angle_rad, expected, 0.01);
  }
}

/// Squared error of the direction at mid exposure by its covariance, without aberration.
double nees_of_direction(const Detection& d, const Wcs& wcs, PixelPosition truth) {
  const auto place = to_spherical(wcs_direction(wcs, truth));
  const double e = std::remainder(d.ra_rad - place[0], 2 * pi) * std::cos(place[1]);
  const double n = d.dec_rad - place[1];
  const auto [ee, en, nn] = d.covariance_rad2;
  return (e * e * nn - 2 * e * n * en + n * n * ee) / (ee * nn - en * en);
}

// A light whose brightness grows while it moves evenly along a bend: density 1 + s r from r = -1 to
// 1 has its centroid at s / 3 of half the length; the object was at r = 0, a third of the sagitta
// off the line of the centroid. A point has both in one place.
TEST(Detect, DirectionIsThatOfMidExposureAndThePixelThatOfTheLight) {
  const auto header = camera_header(1000, 1000, 20 * all_sky_focal_px, declination, 2, true);
  constexpr double length = 240, slope = 0.3, sagitta = 1.5;
  double sum = 0.0;
  for (unsigned seed = 1; seed <= 20; ++seed) {
    SimulatedFrame frame(header, 1000, 1000, sky_e, seed);
    const double angle = 0.15 * seed, c = std::cos(angle), s = std::sin(angle);
    frame.add_streak(500, 500, length, angle, 3000.0 * length, slope, sagitta);
    frame.add_point(100, 100, 40000.0);
    Threads threads;
    const auto result = detect(frame.expose(), header, {}, threads);
    for (const Detection& d : result.detections) {
      if (d.kind == DetectionKind::point) {
        const auto direction = to_spherical(wcs_direction(header.wcs, {d.x_px, d.y_px}));
        EXPECT_EQ(d.ra_rad, direction[0]);
        EXPECT_EQ(d.dec_rad, direction[1]);
        continue;
      }
      EXPECT_NEAR(d.x_px, 500 + slope * length / 6 * c, 0.6);
      EXPECT_NEAR(d.y_px, 500 + slope * length / 6 * s, 0.6);
      sum += nees_of_direction(d, header.wcs, {500 - s * sagitta / 3, 500 + c * sagitta / 3}) / 2;
    }
  }
  EXPECT_GT(sum / 20, 0.4);
  EXPECT_LT(sum / 20, 1.6);
}

TEST(Detect, LimitingMagnitudeIsThatOfHalfThePointsFound) {
  const auto header = camera_header(1000, 1000, all_sky_focal_px, declination, 20, false);
  SimulatedFrame frame(header, 1000, 1000, sky_e, 11);
  Threads threads;
  const double limit = detect(frame.expose(), header, {}, threads).report.limiting_magnitude;
  const double flux_e = 20 * std::pow(10, -0.4 * (limit - header.zero_point_mag));
  for (int row = 0; row < 20; ++row)
    for (int column = 0; column < 20; ++column)
      frame.add_point(30 + 49 * column, 30 + 49 * row, flux_e);
  // Points where stars are points too: counted as star-like. At the threshold noise lifts half of
  // them above it; a little more, since the filter may peak in any pixel nearby.
  const auto found = detect(frame.expose(), header, {}, threads).report.star_like;
  EXPECT_GT(found, 180u);
  EXPECT_LT(found, 300u);
}

}  // namespace
}  // namespace dmise
