#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "core/camera_calibration/gaussian_stars.h"
#include "core/camera_calibration/lens_fit.h"
#include "core/camera_calibration/lens_width.h"
#include "core/camera_calibration/star_zero_point.h"

// tests/reference/calibrate.py has the statistics over cameras whose stars GalSim drew.
namespace dmise {
namespace {

/// Share of a Gaussian in a pixel, by the error function.
double share(double at, double middle, double sigma) {
  const auto below = [&](double x) { return std::erf((x - middle) / (sigma * std::sqrt(2.0))); };
  return 0.5 * (below(at + 0.5) - below(at - 0.5));
}

struct DrawnStars {
  StarPixels pixels{.columns = 200, .rows = 200, .light_e = {}, .hot_e = {}, .saturation_e = 1e9};
  std::vector<FoundStar> places;

  DrawnStars(double sigma_px, double flux_e, double sky_e) {
    pixels.light_e.assign(200 * 200, float(sky_e));
    for (int j = 0; j < 4; ++j)
      for (int i = 0; i < 4; ++i) {
        const PixelPosition at{30.3 + 45.13 * i, 30.7 + 44.87 * j};
        places.push_back({.at = at, .flux_e = flux_e});
        for (std::size_t y = 0; y < 200; ++y)
          for (std::size_t x = 0; x < 200; ++x)
            pixels.light_e[y * 200 + x] += float(flux_e * share(double(x), at.x_px, sigma_px) *
                                                 share(double(y), at.y_px, sigma_px));
      }
  }
};

double all_passes(PixelPosition) { return 1.0; }

TEST(GaussianStars, WidthIsWithoutThePixelAndTheSky) {
  const DrawnStars drawn(0.9, 20000.0, 150.0);
  const auto images = measure_star_images(drawn.pixels, drawn.places, 2.5);
  ASSERT_EQ(images.size(), 16U);
  for (const GaussianStar& image : images) {
    EXPECT_NEAR(image.mean_px2(), 0.81, 0.003);
    EXPECT_NEAR(image.xy_px2, 0.0, 0.003);
    EXPECT_NEAR(image.flux_e, 20000.0, 20.0);
  }
}

// Stars of 4000 and 400,000 e- with Poisson's noise on a sky of 100 e-: widths scatter by what they
// state, 320 of each to 4 %. With the even noise of the window's pixels bright ones would state
// half.
TEST(GaussianStars, DeviationsHoldThePhotonsOfTheStar) {
  std::mt19937_64 random(13);
  for (const double flux_e : {4000.0, 400000.0}) {
    double squares = 0.0, count = 0.0;
    const DrawnStars drawn(0.9, flux_e, 100.0);
    for (int round = 0; round < 20; ++round) {
      StarPixels noisy = drawn.pixels;
      for (float& e : noisy.light_e) e = float(std::poisson_distribution<int>(double(e))(random));
      for (const GaussianStar& star : measure_star_images(noisy, drawn.places, 2.1)) {
        squares += std::pow((star.mean_px2() - 0.81) / star.variance_sigma_px2, 2);
        ++count;
      }
    }
    EXPECT_GT(count, 300.0);
    EXPECT_NEAR(std::sqrt(squares / count), 1.0, 0.15) << flux_e;
  }
}

TEST(GaussianStars, ApertureHoldsAllTheLightAndNoSky) {
  const DrawnStars drawn(0.9, 20000.0, 150.0);
  const auto light = aperture_light(drawn.pixels, drawn.places[5], {}, {}, 2.1, all_passes);
  ASSERT_TRUE(light);
  EXPECT_NEAR(light->flux_e, 20000.0, 5.0);
}

// A sky of 300 e- a pixel through a lens that lets 1 - (r / 250 px)^2 pass: the sky of the ring is
// 0.9 e- darker than that of the aperture, on 346 pixels.
TEST(GaussianStars, ApertureHoldsNoSkyOfALensThatDimsToTheCorners) {
  const auto passes = [](PixelPosition at) {
    return 1 - (std::pow(at.x_px - 99.5, 2) + std::pow(at.y_px - 99.5, 2)) / (250.0 * 250.0);
  };
  DrawnStars drawn(0.9, 20000.0, 0.0);
  for (std::size_t y = 0; y < 200; ++y)
    for (std::size_t x = 0; x < 200; ++x)
      drawn.pixels.light_e[y * 200 + x] += float(300.0 * passes({double(x), double(y)}));
  const auto light = aperture_light(drawn.pixels, drawn.places[5], {}, {}, 2.1, passes);
  ASSERT_TRUE(light);
  EXPECT_NEAR(light->flux_e, 20000.0, 5.0);
}

TEST(GaussianStars, AStarBesideAStrangerIsNotMeasured) {
  const DrawnStars drawn(0.9, 20000.0, 150.0);
  const FoundStar& star = drawn.places[5];
  const std::vector<FoundStar> strangers{
      {.at = star.at + PixelPosition{4.0, 0.0}, .flux_e = 10000.0}};
  EXPECT_FALSE(aperture_light(drawn.pixels, star, strangers, {}, 2.1, all_passes));
}

TEST(LensWidth, GrowsToTheCornerAsTheStarsDo) {
  std::mt19937_64 random(7);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> even(0.0, 999.0);
  const double corner = 0.5 * std::hypot(999.0, 999.0);
  std::vector<GaussianStar> images;
  for (int k = 0; k < 600; ++k) {
    const PixelPosition at{even(random), even(random)};
    const double t = std::pow(std::hypot(at.x_px - 499.5, at.y_px - 499.5) / corner, 2);
    GaussianStar image{.at = at, .variance_sigma_px2 = 0.05};
    image.xx_px2 = 1 + 0.6 * t + 0.05 * normal(random);
    image.yy_px2 = 1 + 0.6 * t + 0.05 * normal(random);
    images.push_back(image);
  }
  const auto width = measure_width(images, 1000, 1000);
  ASSERT_TRUE(width && !width->field.empty());
  const FieldWidth& last = width->field.back();
  EXPECT_NEAR(last.mean_px2.value, 1.6, 4 * last.mean_px2.sigma);
  EXPECT_LT(last.mean_px2.sigma, 0.05);
  EXPECT_LT(std::abs(width->elongation_px2.value), 4 * width->elongation_px2.sigma);
}

/// Weights by a star's own width would make the mean too narrow by 2 * 0.1^2, nine deviations.
TEST(LensWidth, StarsThatNoiseMadeNarrowDoNotWeighMore) {
  std::mt19937_64 random(11);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> even(0.0, 999.0);
  constexpr double noise = 0.1, of_pixel = 1.0 / 12;
  std::vector<GaussianStar> images;
  for (int k = 0; k < 2000; ++k) {
    const double px2 = 1 + noise * normal(random);
    GaussianStar image{.at = {even(random), even(random)}};
    image.xx_px2 = image.yy_px2 = px2;
    image.variance_sigma_px2 = noise * (px2 + of_pixel) / (1 + of_pixel);
    images.push_back(image);
  }
  const auto width = measure_width(images, 1000, 1000);
  ASSERT_TRUE(width);
  EXPECT_NEAR(width->even_px2.value, 1.0, 3 * width->even_px2.sigma);
  EXPECT_LT(width->even_px2.sigma, 1.6 * noise / std::sqrt(2000.0));
}

/// Weights by a star's own light would make the mean too bright by twice the square of its noise.
TEST(StarZeroPoint, StarsThatNoiseMadeBrightDoNotWeighMore) {
  std::mt19937_64 random(12);
  std::normal_distribution<double> normal;
  const double mag_per_relative = 2.5 / std::log(10.0), noise = 0.025;
  std::vector<StarZeroPoint> stars;
  for (int k = 0; k < 8000; ++k) {
    const double light = 1 + noise * normal(random);
    stars.push_back({20.0 + 2.5 * std::log10(light), mag_per_relative * noise / light, 0.65, 0});
  }
  const auto zero = joint_zero_point(stars);
  ASSERT_TRUE(zero);
  EXPECT_NEAR(zero->value, 20.0, 3 * zero->sigma);
  EXPECT_LT(zero->sigma, 1.3 * mag_per_relative * noise / std::sqrt(8000.0));
}

TEST(StarZeroPoint, IsThatOfAStarLikeTheSun) {
  std::mt19937_64 random(8);
  std::normal_distribution<double> normal;
  std::vector<StarZeroPoint> stars;
  for (int k = 0; k < 400; ++k) {
    const double bv = 0.2 + 0.01 * (k % 100);
    stars.push_back({20.0 + 0.1 * (bv - 0.65) + 0.02 * normal(random), 0.02, bv, 0});
  }
  const auto zero = joint_zero_point(stars);
  ASSERT_TRUE(zero);
  EXPECT_NEAR(zero->value, 20.0, 4 * zero->sigma);
  EXPECT_NEAR(zero->sigma, 0.02 / std::sqrt(400.0), 0.0005);
}

/// Stars over a frame of 1000 x 1000 pixels through a lens whose image height is f u (1 + k1 u^2).
std::vector<LensFrame> frames_through(double focal_px, double k1, int count) {
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal;
  std::uniform_real_distribution<double> even(-0.2, 0.2);
  std::vector<LensFrame> frames;
  for (int f = 0; f < count; ++f) {
    LensFrame frame;
    frame.camera_from_gcrs.m = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}}};
    for (int k = 0; k < 200; ++k) {
      const double u = even(random), v = even(random),
                   scale = focal_px * (1 + k1 * (u * u + v * v));
      PlateMatch match;
      match.pixel = {499.5 + scale * u + 0.05 * normal(random),
                     499.5 + scale * v + 0.05 * normal(random)};
      match.covariance_px2 = {0.0025, 0.0, 0.0025};
      match.direction = unit(Vec<Gcrs>{u, v, 1.0});
      frame.matches.push_back(match);
    }
    frames.push_back(frame);
  }
  return frames;
}

TEST(LensFit, FindsFocalLengthAndDistortionOfAllFrames) {
  const auto fit =
      fit_lens(frames_through(2500.0, -0.1, 3), Projection::gnomonic, 2490.0, 1000, 1000);
  ASSERT_TRUE(fit && fit->distorted);
  EXPECT_STREQ(fit->projection.name(), "brown_conrady");
  EXPECT_NEAR(fit->focal_length_px.value, 2500.0, 4 * fit->focal_length_px.sigma);
  EXPECT_NEAR(fit->coefficients[0].value, -0.1, 4 * fit->coefficients[0].sigma);
  EXPECT_LT(fit->coefficients[0].sigma, 0.005);
}

TEST(LensFit, AnEvenLensStaysGnomonic) {
  const auto fit =
      fit_lens(frames_through(2500.0, 0.0, 3), Projection::gnomonic, 2490.0, 1000, 1000);
  ASSERT_TRUE(fit);
  EXPECT_FALSE(fit->distorted);
  EXPECT_STREQ(fit->projection.name(), "gnomonic");
  EXPECT_NEAR(fit->focal_length_px.value, 2500.0, 4 * fit->focal_length_px.sigma);
}

}  // namespace
}  // namespace dmise
