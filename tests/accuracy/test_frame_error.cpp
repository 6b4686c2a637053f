#include "sensors/accuracy/frame_error.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <numbers>

#include "core/base/error.h"
#include "sensors/accuracy/source_capsule.h"

namespace dmise {
namespace {

/// A star of 9 mag in the middle of 64 x 64 pixels, on a sky without structure.
class FrameErrors : public testing::Test {
 public:
  ~FrameErrors() override { std::filesystem::remove_all(directory_); }

 protected:
  explicit FrameErrors(const std::string& blur = "") {
    setenv("DMISE_HOME", DMISE_SOURCE_DIR, 1);
    directory_ =
        std::filesystem::path(testing::TempDir()) /
        (std::string("accuracy-") + testing::UnitTest::GetInstance()->current_test_info()->name());
    std::filesystem::create_directories(directory_);
    std::ofstream(directory_ / "stars.csv") << "ra_deg,dec_deg,mag_v,id,bv\n85.2,0.7,9,1,0.6\n";
    std::ofstream(directory_ / "scene.yaml") << R"(
simulation: {start: 2018-01-21T00:15:00Z, duration_s: 5, tick_s: 5, seed: 1}
objects: [{name: carrier, motion: {two_body: {semi_major_axis_m: 7178137, eccentricity: 0,
  inclination_deg: 98.6, raan_deg: 0, true_anomaly_deg: 0}}}]
stars: {catalogue: stars.csv, faintest_mag: 12}
effects: {annual_aberration: off, diurnal_aberration: off}
detection: off
sensors:
  - name: eye
    platform: carrier
    camera:
      optics: {columns: 64, rows: 64, pixel_pitch_m: 1.0e-5, focal_length_m: 0.1, aperture_m: 0.05)"
                                             << blur << R"(}
      detector: {full_well_e: 1000000, gain_e_per_dn: 2, read_noise_e: 5}
      band: {centre_m: 0.55e-6, width_m: 0.1e-6}
    pointing: {ra_deg: 85.2, dec_deg: 0.7}
    exposure_s: 1
    cadence_s: 5
    sky: 20
)";
    frames_.emplace(load_scenario((directory_ / "scene.yaml").string()), "eye", 1, threads_);
    reference_ = frames_->make(frames_->sensor());
    comparison_.emplace(*frames_, reference_, frames_->sensor().effects);
  }

  FrameError error_of(const FrameProducts& frame) const {
    return comparison_->error_of(frame, frames_->sensor().effects);
  }
  FrameProducts with_sources(const ExpectedElectronImage& sources) const {
    FrameProducts frame;
    frame.planes.background = reference_.planes.background;
    frame.planes.sources = sources;
    return frame;
  }

  Threads threads_{1};
  std::filesystem::path directory_;
  std::optional<SceneFrames> frames_;
  FrameProducts reference_;
  std::optional<FrameComparison> comparison_;
};

TEST_F(FrameErrors, OfTheReferenceAreNone) {
  ASSERT_EQ(comparison_->sources().size(), 1u);
  EXPECT_TRUE(comparison_->sources()[0].counts);
  EXPECT_NEAR(comparison_->sources()[0].centroid.x_px, 31.5, 0.1);
  const FrameError error = error_of(with_sources(reference_.planes.sources));
  for (const auto& kind : error_kinds) EXPECT_EQ(error.largest.*kind.value, 0.0) << kind.key;
  EXPECT_EQ(error.residual_sigma, 0.0);
}

TEST_F(FrameErrors, OnePercentOfLightIsOnePercentInMagnitudes) {
  auto sources = reference_.planes.sources;
  for (float& e : sources.pixels) e *= 1.01f;
  const FrameError error = error_of(with_sources(sources));
  EXPECT_NEAR(error.largest.photometry_mag, 2.5 * std::log10(1.01), 1e-5);
  EXPECT_NEAR(error.largest.position_px, 0.0, 1e-5);
}

TEST_F(FrameErrors, AShiftByAPixelIsAPixel) {
  auto sources = reference_.planes.sources;
  for (int y = 0; y < sources.rows; ++y)
    std::rotate(sources.row(y), sources.row(y) + sources.columns - 1,
                sources.row(y) + sources.columns);
  const FrameError error = error_of(with_sources(sources));
  EXPECT_NEAR(error.largest.position_px, 1.0, 2e-3);
  EXPECT_NEAR(error.largest.photometry_mag, 0.0, 2e-3);
  EXPECT_LT(error.largest.background_sigma, 0.01);  // a misplaced source is no background
}

TEST_F(FrameErrors, BackgroundIsMeasuredInItsNoise) {
  FrameProducts frame = with_sources(reference_.planes.sources);
  const double sky_e = frame.planes.background.at(12, 12);  // in 1 s
  const double noise_e = std::sqrt(sky_e + 25.0);
  frame.planes.background.at(12, 12) += float(0.3 * noise_e);
  const FrameError error = error_of(frame);
  EXPECT_NEAR(error.largest.background_sigma, 0.3, 1e-4);
  EXPECT_EQ(error.largest.photometry_mag, 0.0);
  // Noise of the sky, the read-out and rounding to 2 e-.
  const double variance = sky_e + 25.0 + 4.0 / 12.0;
  EXPECT_NEAR(error.largest.noise, std::sqrt(1.0 + 0.3 * noise_e / variance) - 1.0, 1e-4);
}

/// The star of `FrameErrors`, blurred by diffraction.
class FrameErrorsOfABlur : public FrameErrors, public testing::WithParamInterface<const char*> {
 protected:
  FrameErrorsOfABlur()
      : FrameErrors(std::string(", psf: diffraction, jitter_px: 0.5, method: ") + GetParam()) {}

  FrameError with_more_at_star_row(double more_e) const {
    FrameProducts frame = with_sources(reference_.planes.sources);
    frame.planes.background.at(8, 32) += float(more_e);
    return error_of(frame);
  }
};

// A transform in single precision rounds by what is brightest in a row and in the frame. What is
// less than that says nothing of a level; what is more is an error all the same, and where nothing
// is transformed all of it is.
TEST_P(FrameErrorsOfABlur, RoundingOfATransformIsNoError) {
  const auto& sources = reference_.planes.sources;
  const double brightest_e = *std::max_element(sources.pixels.begin(), sources.pixels.end());
  ASSERT_GT(brightest_e, 1e3);
  const double min_e = 0x1p-22 * brightest_e,
               noise_e = std::sqrt(double(reference_.planes.background.at(8, 32)) + 25.0);
  const bool transformed = std::string(GetParam()) == "transform";
  EXPECT_NEAR(with_more_at_star_row(min_e).largest.background_sigma,
              transformed ? 0.0 : min_e / noise_e, 0.2 * min_e / noise_e);
  EXPECT_NEAR(with_more_at_star_row(1.0).largest.background_sigma, 1.0 / noise_e,
              (transformed ? 4.0 : 0.2) * min_e / noise_e);
}

INSTANTIATE_TEST_SUITE_P(Methods, FrameErrorsOfABlur, testing::Values("transform", "direct"),
                         [](const auto& each) { return std::string(each.param); });

// A trail of 300 px that bends by an eighth of a circle is followed to a third of a pixel; two
// chords would be 6 px off.
TEST(LineAlong, FollowsATrailThatBends) {
  constexpr double radius_px = 190.0, pi = std::numbers::pi;
  const auto at = [](double angle) {
    return PixelPosition{radius_px * std::cos(angle), radius_px * std::sin(angle)};
  };
  const auto line = line_along(at(-pi / 8), at(0.0), at(pi / 8));
  EXPECT_EQ(line.front(), at(-pi / 8));
  EXPECT_EQ(line.back(), at(pi / 8));
  for (std::size_t i = 1; i < line.size(); ++i) {
    const PixelPosition middle = (line[i] + line[i - 1]) * 0.5;
    EXPECT_NEAR(std::hypot(line[i].x_px, line[i].y_px), radius_px, 0.33);
    EXPECT_NEAR(std::hypot(middle.x_px, middle.y_px), radius_px, 0.33);
  }
}

TEST(LineAlong, IsAPointForAPointAndOneChordForAStraightTrail) {
  EXPECT_EQ(line_along({3, 4}, {3, 4}, {3, 4}), (std::vector<PixelPosition>{{3, 4}, {3, 4}}));
  EXPECT_EQ(line_along({0, 0}, {2, 1}, {4, 2}), (std::vector<PixelPosition>{{0, 0}, {4, 2}}));
}

TEST_F(FrameErrors, RefusesAFrameThatDoesNotExist) {
  EXPECT_THROW(SceneFrames(frames_->scenario(), "eye", 2, threads_), ConfigError);
  EXPECT_THROW(SceneFrames(frames_->scenario(), "ear", 1, threads_), ConfigError);
}

}  // namespace
}  // namespace dmise
