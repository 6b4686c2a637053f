#include "core/astrometry/calibrated_detection.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/base/error.h"
#include "core/base/numeric/rng.h"
#include "core/image/known_defects.h"
#include "core/sky/stars/star_cache.h"
#include "core/wcs/wcs.h"
#include "tests/support/data.h"
#include "tests/support/simulated_frame.h"

namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;

constexpr int columns = 1400, rows = 1200;
constexpr double focal_px = 3000.0, dec_rad = 0.5, ra_rad = 1.3, exposure_s = 2.0;

/// A camera in space, 26 deg wide, at a right ascension.
FrameHeader header_at(double ra) {
  FrameHeader h = camera_header(columns, rows, focal_px, dec_rad, exposure_s, false, ra);
  h.zero_point_mag = 17.5;
  h.sensor_position_m = {7e6, 0, 0};
  h.sensor_velocity_m_per_s = {0, 7.5e3, 0};
  return h;
}

struct CalibratedDetection : testing::Test {
  std::shared_ptr<const StarMap> map;
  FrameHeader truth = header_at(ra_rad);
  Threads threads{2};

  void SetUp() override {
    map = std::make_shared<const StarMap>(load_star_map(test::catalogue_path("stars.dat.gz")));
  }
  /// The catalogue's stars by `light`, and a satellite of SNR 60.
  CountImage drawn(double light) {
    SimulatedFrame frame(truth, columns, rows, 400, 3);
    for (const ExpectedStar& star : CatalogueSky(map).stars_in(truth, columns, rows, 10.0))
      frame.add_point(star.place.x_px, star.place.y_px, light * star.signal_e);
    frame.add_streak(700, 500, 80, 0.4, 20000);
    return frame.expose();
  }
  /// The satellite is where it is by the true header, and at its pixel.
  void expect_satellite(const DetectionResult& result) {
    const auto right = detect(drawn(1.0), truth, {}, threads);
    ASSERT_EQ(right.detections.size(), 1u);
    ASSERT_EQ(result.detections.size(), 1u);
    const Detection &d = result.detections[0], &expected = right.detections[0];
    EXPECT_NEAR(d.x_px, 700, 0.3);
    EXPECT_NEAR(d.y_px, 500, 0.3);
    EXPECT_LT(angle_rad(from_spherical<Gcrs>(d.ra_rad, d.dec_rad),
                        from_spherical<Gcrs>(expected.ra_rad, expected.dec_rad)),
              0.05 / focal_px);
  }
};

TEST_F(CalibratedDetection, BelievesAHeaderThatIsRight) {
  const auto result = CalibratedDetector(map).detect({drawn(1.0), truth}, threads);
  EXPECT_TRUE(result.detection.stars.agree());
  EXPECT_FALSE(result.solution);
  EXPECT_EQ(result.header, truth);
  expect_satellite(result.detection);
}

/// The only text of a list that begins so; empty if there is none.
std::string noted(const std::vector<std::string>& notes, const std::string& begin) {
  for (const std::string& text : notes)
    if (text.starts_with(begin)) return text;
  return {};
}

TEST_F(CalibratedDetection, NotesThatTheStarsAreNotWhereTheWcsHasThem) {
  const auto result =
      CalibratedDetector(map).detect({drawn(1.0), header_at(ra_rad + 0.3)}, threads);
  EXPECT_FALSE(result.solution);
  EXPECT_EQ(noted(result.notes.missing, "stars: "),
            "stars: no plate was found near the WCS, which they do not confirm; --blind searches "
            "the whole sky");
}

TEST_F(CalibratedDetection, NotesWhyTheCatalogueIsNotUsed) {
  for (const auto& [fact, text] :
       {std::pair{FrameFact::time, "a time"}, {FrameFact::exposure, "an exposure time"}}) {
    FrameHeader header = truth;
    header.unknown.add(fact);
    header.unknown.add(FrameFact::zero_point);
    const auto result = CalibratedDetector(map).detect({drawn(1.0), header}, threads);
    EXPECT_EQ(noted(result.notes.missing, "stars: "),
              std::string("stars: the catalogue is not used without ") + text);
  }
}

// By the zero point none is bright enough; and clouds hide them.
TEST_F(CalibratedDetection, NotesThatItsStarsAreNotSeen) {
  for (const double zero_point_mag : {-20.0, 0.0, 5.0}) {
    FrameHeader header = truth;
    header.zero_point_mag = zero_point_mag;
    const auto result = CalibratedDetector(map).detect({drawn(1.0), header}, threads);
    EXPECT_EQ(result.detection.stars.expected, 0);
    EXPECT_EQ(noted(result.notes.missing, "stars: "),
              "stars: the catalogue is not used: none of its stars is expected to be seen");
  }
  const auto clouds = CalibratedDetector(map).detect({drawn(0.0), truth}, threads);
  const StarsSeen& few = clouds.detection.stars;  // by noise
  EXPECT_EQ(noted(clouds.notes.missing, "stars: "),
            "stars: the catalogue is not used: " + std::to_string(few.found) + " of " +
                std::to_string(few.expected) + " stars are where they are expected");
  const auto seen = CalibratedDetector(map).detect({drawn(1.0), truth}, threads);
  EXPECT_EQ(noted(seen.notes.missing, "stars: "), "");
  FrameHeader closed = truth;
  closed.exclusion.action = ExclusionAction::close_shutter;
  closed.excluded.sun = true;
  EXPECT_EQ(
      noted(CalibratedDetector(map).detect({drawn(0.0), closed}, threads).notes.missing, "stars: "),
      "");
}

TEST_F(CalibratedDetection, DropsTheNotesOfWhatASolutionFinds) {
  FrameHeader header = truth;
  header.unknown.add(FrameFact::zero_point);
  Frame frame{drawn(1.0), header};
  frame.notes.missing = {"band: no FILTER", "zero point: no magnitudes; dmise solve finds it"};
  const auto result = CalibratedDetector(map).detect(frame, threads);
  ASSERT_TRUE(result.solution);
  EXPECT_EQ(result.notes.missing, std::vector<std::string>{"band: no FILTER"});
}

TEST_F(CalibratedDetection, FindsItByADirectionWithoutAFocalLength) {
  FrameHeader believed = header_at(0.0);
  believed.unknown.add(FrameFact::pointing);
  believed.unknown.add(FrameFact::focal_length);
  believed.focal_length_px = 1e4;
  believed.observation.ra_rad = ra_rad;
  believed.observation.dec_rad = dec_rad + 0.017;
  const auto result = CalibratedDetector(map).detect({drawn(1.0), believed}, threads);
  ASSERT_TRUE(result.solution);
  expect_satellite(result.detection);
}

// Two and a half degrees off: directions are those of the stars, not those of the header.
TEST_F(CalibratedDetection, FindsWhereTheFramePoints) {
  const FrameHeader believed = header_at(ra_rad + 0.05);
  const auto result = CalibratedDetector(map).detect({drawn(1.0), believed}, threads);
  ASSERT_TRUE(result.solution);
  EXPECT_TRUE(result.detection.stars.agree());
  expect_satellite(result.detection);
}

// RA and DEC a degree off, and no WCS.
TEST_F(CalibratedDetection, FindsItByADirectionAlone) {
  FrameHeader believed = header_at(0.0);
  believed.unknown.add(FrameFact::pointing);
  believed.observation.ra_rad = ra_rad;
  believed.observation.dec_rad = dec_rad + 0.017;
  const auto result = CalibratedDetector(map).detect({drawn(1.0), believed}, threads);
  ASSERT_TRUE(result.solution);
  EXPECT_FALSE(result.header.unknown.has(FrameFact::pointing));
  expect_satellite(result.detection);
}

TEST_F(CalibratedDetection, FindsItWithoutAnyPointing) {
  const FrameHeader believed = header_at(ra_rad + 2.0);
  const auto result = CalibratedDetector(map).detect({drawn(1.0), believed}, threads, true);
  ASSERT_TRUE(result.solution);
  expect_satellite(result.detection);
}

// In clouds, and with a header that is too wrong, the satellite is found by its shape.
TEST_F(CalibratedDetection, GoesOnWithoutStars) {
  const auto clouds = CalibratedDetector(map).detect({drawn(0.0), truth}, threads);
  EXPECT_FALSE(clouds.solution);
  EXPECT_FALSE(clouds.detection.stars.agree());
  EXPECT_EQ(clouds.detection.detections.size(), 1u);
  EXPECT_THROW(CalibratedDetector(map).detect({drawn(0.0), truth}, threads, true), Error);
  const auto without = CalibratedDetector(nullptr).detect({drawn(1.0), truth}, threads);
  EXPECT_EQ(without.detection.detections.size(), 1u);
  EXPECT_THROW(CalibratedDetector(nullptr).detect({drawn(1.0), truth}, threads, true), Error);
}

// As of a short-wave infrared camera: a thousandth of the pixels, of which those whose charge is
// more than the noise in the dark have no value, and the sky's level.
TEST_F(CalibratedDetection, HotPixelsOfTheCamerasListHaveNoValue) {
  FrameHeader h = truth;
  h.detector.emplace();
  h.detector->hot_pixel_fraction = 1e-3;
  h.detector->hot_pixel_e_per_s = 5000;
  h.sensor = "hot";
  h.seed = 5;
  const CountImage clean = drawn(1.0);
  CountImage counts = clean;
  const auto hot = static_cast<const HotPixels&>(*h.detector)
                       .among(counts.pixels.size(), rng_key(5, "hot", 0, "hot_pixels"));
  ASSERT_GT(hot.size(), 1000u);
  for (const HotPixel& pixel : hot) {
    const double more =
        counts.pixels[pixel.pixel] + double(pixel.dark_e_per_s) * exposure_s / h.gain_e_per_dn;
    counts.pixels[pixel.pixel] = std::uint16_t(std::min(more, 65535.0));
  }
  const auto calibrated = without_hot_pixels({counts, h});
  ASSERT_TRUE(calibrated);
  std::size_t far = 0;
  for (const HotPixel& pixel : hot) {
    const bool seen = double(pixel.dark_e_per_s) * exposure_s > h.read_noise_e;
    EXPECT_EQ(calibrated->unusable.pixels[pixel.pixel], seen ? 1 : 0);
    far +=
        seen && std::abs(calibrated->counts.pixels[pixel.pixel] - clean.pixels[pixel.pixel]) > 300;
  }
  EXPECT_LT(far, hot.size() / 20);  // those on stars
  EXPECT_FALSE(without_hot_pixels({clean, truth}));
  expect_satellite(CalibratedDetector(map).detect({counts, h}, threads).detection);
}

}  // namespace
}  // namespace dmise
