#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <random>

#include "core/detection/detect.h"
#include "core/wcs/wcs.h"
#include "tests/support/simulated_frame.h"

// Detection with a catalogue of stars: what is in it is no satellite, what is not is no star.
namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;

constexpr double sky_e = 1500.0, exposure_s = 2.0;
constexpr int columns = 900, rows = 700;

/// Stars to V = 9 over the frame, three times as many for each magnitude; the catalogue is taken as
/// complete to 8.
std::shared_ptr<const StarMap> random_stars(const FrameHeader& header, int count,
                                            double pm_rad_per_yr = 0.0) {
  std::mt19937_64 random(5);
  const auto uniform = [&](double from, double to) {
    return from + (to - from) * double(random() >> 11) * 0x1p-53;
  };
  StarCatalogue stars;
  stars.epoch_jyear = 2000.0;
  for (int i = 0; i < count; ++i) {
    const auto place = to_spherical(
        wcs_direction(header.wcs, {uniform(-10, columns + 10), uniform(-10, rows + 10)}));
    const double v_mag = 9.0 + std::log(uniform(1e-4, 1.0)) / std::log(3.0);
    EXPECT_EQ(append_star(stars, {.id = std::uint32_t(i + 1),
                                  .ra_rad = place[0],
                                  .dec_rad = place[1],
                                  .pm_ra_cosdec_rad_per_yr = pm_rad_per_yr,
                                  .pm_dec_rad_per_yr = -pm_rad_per_yr,
                                  .v_mag = v_mag,
                                  .bv = 0.65}),
              nullptr);
  }
  return std::make_shared<const StarMap>(star_map_of(std::move(stars)));
}

/// A star of V = 8 has an SNR of 6: 650 e-.
FrameHeader header_of_camera() {
  FrameHeader h = camera_header(columns, rows, 1663, 0.6, exposure_s, false);
  h.zero_point_mag = 8.0 + 2.5 * std::log10(650.0 / exposure_s);
  return h;
}

class KnownStars : public testing::Test {
 protected:
  FrameHeader header_ = header_of_camera();
  std::shared_ptr<const StarMap> map_ = random_stars(header_, 3000);
  CatalogueSky sky_{map_};
  Threads threads_{2};

  SimulatedFrame frame(unsigned seed, PixelPosition shift = {}, double light = 1.0) {
    SimulatedFrame frame(header_, columns, rows, sky_e, seed);
    for (const ExpectedStar& star : sky_.stars_in(header_, columns, rows, 5.0))
      frame.add_point(star.place.x_px + shift.x_px, star.place.y_px + shift.y_px,
                      light * star.signal_e);
    return frame;
  }
  std::vector<Detection> detections(const CountImage& counts, bool with_catalogue = true) {
    return detect(counts, header_, {}, threads_, with_catalogue ? &sky_ : nullptr).detections;
  }
};

TEST_F(KnownStars, AreExpectedByTheirPlaceAndMagnitude) {
  const auto stars = sky_.stars_in(header_, columns, rows, 1.0);
  EXPECT_NEAR(double(stars.size()), 3000.0, 3.0);  // 20 px around the frame
  EXPECT_EQ(sky_.complete_to_v_mag(), 8.0);
  double brightest = 0.0;
  for (const ExpectedStar& star : stars) brightest = std::max(brightest, star.signal_e);
  double min_v = 99.0;
  for (const float v : map_->stars.v_mag) min_v = std::min(min_v, double(v));
  EXPECT_NEAR(brightest, exposure_s * std::pow(10.0, 0.4 * (header_.zero_point_mag - min_v)),
              1e-3 * brightest);
  EXPECT_TRUE(sky_.stars_in(header_, columns, rows, 2 * brightest).empty());
}

TEST_F(KnownStars, HaveMovedSinceTheCataloguesEpoch) {
  // 0.1 arcsec a year each way for the 18.05 years to January 2018; 124 arcsec is a pixel.
  const double pm = 60 * arcsec;
  const CatalogueSky moving(random_stars(header_, 3000, pm));
  const auto before = sky_.stars_in(header_, columns, rows, 1.0);
  const auto after = moving.stars_in(header_, columns, rows, 1.0);
  double dx = 0.0, dy = 0.0;
  int pairs = 0;
  for (const ExpectedStar& a : after)
    for (const ExpectedStar& b : before)
      if (std::abs(a.signal_e - b.signal_e) < 1e-6 * a.signal_e) {
        dx += a.place.x_px - b.place.x_px;
        dy += a.place.y_px - b.place.y_px;
        ++pairs;
      }
  ASSERT_GT(pairs, 2000);
  const double moved_px = 18.05 * 60 / 124.0;  // columns to the north
  EXPECT_NEAR(std::abs(dx / pairs), moved_px, 0.3);
  EXPECT_NEAR(std::abs(dy / pairs), moved_px, 0.3);
}

TEST_F(KnownStars, AreNoDetections) {
  for (unsigned seed = 0; seed < 8; ++seed)
    EXPECT_TRUE(detections(frame(seed).expose()).empty()) << seed;
}

// Points that look like the stars, of SNR 9 to 15: only the catalogue tells them.
TEST_F(KnownStars, LeavePointsThatAreNoStars) {
  int found = 0, placed = 0, others = 0;
  for (unsigned seed = 0; seed < 4; ++seed) {
    SimulatedFrame image = frame(20 + seed);
    std::vector<PixelPosition> places;
    for (int i = 0; i < 25; ++i)
      places.push_back({100.0 + 170 * (i % 5) + image.uniform(-20, 20),
                        80.0 + 130 * (i / 5) + image.uniform(-20, 20)});
    for (const PixelPosition& p : places)
      image.add_point(p.x_px, p.y_px, image.uniform(1000, 1700));
    const CountImage counts = image.expose();
    for (const Detection& d : detections(counts)) {
      const bool real = std::any_of(places.begin(), places.end(), [&](const PixelPosition& p) {
        return std::hypot(d.x_px - p.x_px, d.y_px - p.y_px) < 1.0;
      });
      (real ? found : others) += 1;
    }
    placed += int(places.size());
    EXPECT_TRUE(detections(counts, false).empty());  // nothing tells them without it
  }
  EXPECT_GT(found, placed * 3 / 4);  // a tenth lies on stars
  EXPECT_EQ(others, 0);
}

// Where the header is wrong by a pixel, in clouds, or altogether, no star becomes a detection.
TEST_F(KnownStars, MayBeElsewhereOrBehindClouds) {
  EXPECT_TRUE(detections(frame(40, {1.2, -0.9}).expose()).empty());
  EXPECT_TRUE(detections(frame(41, {40.0, 25.0}).expose()).empty());
  EXPECT_TRUE(detections(frame(42, {}, 0.4).expose()).empty());
  EXPECT_TRUE(detections(frame(43, {}, 0.0).expose()).empty());
}

// Points whose light touches that of a brighter star, 2 to 7 FWHM away: the two together are longer
// than a star. Each point is 10 px or more from the light of others.
TEST_F(KnownStars, LeavePointsOnTheRimOfTheirWings) {
  header_.psf_fwhm_px = 2.4;
  const auto stars = sky_.stars_in(header_, columns, rows, 300.0);
  const auto is_clear = [](const auto& places, PixelPosition at, double px, double but_e) {
    return std::ranges::all_of(places, [&](const ExpectedStar& other) {
      return other.signal_e == but_e ||
             std::hypot(other.place.x_px - at.x_px, other.place.y_px - at.y_px) > px;
    });
  };
  int placed = 0, found = 0;
  for (unsigned seed = 0; seed < 8; ++seed) {
    SimulatedFrame image = frame(80 + seed);
    std::vector<ExpectedStar> points;
    for (const ExpectedStar& star : stars) {
      if (star.signal_e < 5000 || star.signal_e > 100000) continue;
      const double px = image.uniform(5, 17), angle = image.uniform(0, 2 * pi);
      const PixelPosition at{star.place.x_px + px * std::cos(angle),
                             star.place.y_px + px * std::sin(angle)};
      if (at.x_px < 20 || at.y_px < 20 || at.x_px > columns - 20 || at.y_px > rows - 20 ||
          !is_clear(stars, at, 10.0, star.signal_e) || !is_clear(points, at, 40.0, 0.0))
        continue;
      points.push_back({at, image.uniform(8000, 12000)});
      image.add_point(at.x_px, at.y_px, points.back().signal_e);
    }
    placed += int(points.size());
    for (const Detection& d : detections(image.expose())) {
      const bool real = !is_clear(points, {d.x_px, d.y_px}, 1.0, 0.0);
      // Stars without a known place scatter the sky: a few reach the threshold.
      EXPECT_TRUE(real || d.snr < 7)
          << seed << ": " << d.x_px << ", " << d.y_px << ", SNR " << d.snr;
      found += real;
    }
  }
  EXPECT_GE(placed, 100);
  EXPECT_GE(found, placed * 98 / 100);
}

// A hot column is no scatter of the sky: points 8 px from it and more are found as without it.
TEST_F(KnownStars, LeavePointsBesideAHotColumn) {
  header_.psf_fwhm_px = 2.4;
  constexpr int hot = 455;
  SimulatedFrame image = frame(90);
  std::vector<PixelPosition> places;
  for (int i = 0; i < 28; ++i)
    places.push_back({hot + (i % 2 == 0 ? 8.0 : -8.0) + (i % 2 == 0 ? 2.5 : -2.5) * (i / 2),
                      image.uniform(0, 4) + 24.0 * i + 20});
  for (const PixelPosition& p : places) image.add_point(p.x_px, p.y_px, image.uniform(3000, 20000));
  const CountImage clean = image.expose();
  const auto found_in = [&](const CountImage& counts) {
    int found = 0;
    for (const Detection& d : detections(counts)) {
      const bool real = std::ranges::any_of(places, [&](const PixelPosition& p) {
        return std::hypot(d.x_px - p.x_px, d.y_px - p.y_px) < 1.0;
      });
      EXPECT_TRUE(real) << d.x_px << ", " << d.y_px << ", SNR " << d.snr;
      found += real;
    }
    return found;
  };
  const int all = found_in(clean);
  EXPECT_GE(all, 24);
  for (const std::uint16_t level : {0, 4000, 6000, 10000, 20000, 40000, 65535}) {
    CountImage counts = clean;
    for (int y = 0; y < rows; ++y) counts.row(y)[hot] = level;
    EXPECT_GE(found_in(counts), all - 1) << level;
  }
}

TEST_F(KnownStars, ShowAStreakThatCrossesThem) {
  SimulatedFrame image = frame(50);
  image.add_streak(450, 350, 400, 0.3, 30000);
  const auto found = detections(image.expose());
  ASSERT_EQ(found.size(), 1u);
  EXPECT_NEAR(
      std::hypot(found[0].end1_x_px - found[0].end2_x_px, found[0].end1_y_px - found[0].end2_y_px),
      400, 4);
}

// An end behind a star is anywhere behind it: the covariance says so.
TEST_F(KnownStars, HideEndsWhoseErrorsAreStated) {
  const auto stars = sky_.stars_in(header_, columns, rows, 5.0);
  double squares = 0.0, wider = 0.0;
  int measured = 0;
  for (const ExpectedStar& star : stars) {
    const double angle = 0.3, length = 60.0;
    const PixelPosition middle{star.place.x_px - 0.5 * length * std::cos(angle),
                               star.place.y_px - 0.5 * length * std::sin(angle)};
    if (star.signal_e < 20000 || star.signal_e > 60000 || middle.x_px < 80 || middle.y_px < 80 ||
        middle.x_px > columns - 80 || middle.y_px > rows - 80)
      continue;
    const auto along_sigma_px = [&](bool with_stars, PixelPosition& error) {
      SimulatedFrame image =
          with_stars ? frame(70) : SimulatedFrame(header_, columns, rows, sky_e, 70);
      image.add_streak(middle.x_px, middle.y_px, length, angle, 12000);
      for (const Detection& d : detections(image.expose())) {
        error = {d.x_px - middle.x_px, d.y_px - middle.y_px};
        if (std::hypot(error.x_px, error.y_px) > 8) continue;
        const double c = std::cos(angle), s = std::sin(angle);
        const auto [xx, xy, yy] = d.covariance_px2;
        return std::sqrt(xx * c * c + 2 * xy * c * s + yy * s * s);
      }
      return 0.0;
    };
    PixelPosition error, alone;
    const double sigma = along_sigma_px(true, error), free = along_sigma_px(false, alone);
    if (!(sigma > 0 && free > 0)) continue;
    const double along = error.x_px * std::cos(0.3) + error.y_px * std::sin(0.3);
    squares += along * along / (sigma * sigma);
    wider += sigma / free;
    if (++measured == 6) break;
  }
  ASSERT_GE(measured, 3);
  EXPECT_GT(wider / measured, 1.5);
  EXPECT_LT(squares / measured, 4.0);
}

TEST_F(KnownStars, GiveTheSameWithAnyNumberOfThreads) {
  SimulatedFrame image = frame(60);
  image.add_streak(450, 350, 60, 0.3, 9000);
  image.add_point(200, 300, 3000);
  const CountImage counts = image.expose();
  Threads one(1), three(3);
  const auto a = detect(counts, header_, {}, one, &sky_),
             b = detect(counts, header_, {}, three, &sky_);
  ASSERT_EQ(a.detections.size(), b.detections.size());
  EXPECT_GE(a.detections.size(), 2u);
  for (std::size_t i = 0; i < a.detections.size(); ++i) {
    EXPECT_EQ(a.detections[i].x_px, b.detections[i].x_px);
    EXPECT_EQ(a.detections[i].signal_e, b.detections[i].signal_e);
  }
}

}  // namespace
}  // namespace dmise
