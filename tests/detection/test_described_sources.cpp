#include "core/detection/described_sources.h"

#include <gmock/gmock.h>

#include <cmath>
#include <limits>

#include "core/base/error.h"
#include "core/wcs/wcs.h"
#include "tests/support/simulated_frame.h"

namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;

constexpr double nan = std::numeric_limits<double>::quiet_NaN();

MeasuredSource point(double x_px, double y_px) {
  return {.centroid = {{x_px, y_px}, {0.04, 0.01, 0.09}}, .light_e = 2000, .snr = 40};
}

MeasuredSource streak(double x1_px, double y1_px, double x2_px, double y2_px) {
  MeasuredSource source = point((x1_px + x2_px) / 2, (y1_px + y2_px) / 2);
  source.ends = {{{{x1_px, y1_px}, {0.2, 0, 0.2}}, {{x2_px, y2_px}, {0.3, 0, 0.3}}}};
  return source;
}

std::string complaint(const MeasuredSource& source) {
  try {
    check_sources({point(1, 1), source}, 200, 100);
  } catch (const Error& error) {
    return error.what();
  }
  return "";
}

TEST(MeasuredSource, IsCheckedByNumber) {
  const auto with = [](auto change) {
    MeasuredSource source = streak(10, 20, 30, 20);
    change(source);
    return complaint(source);
  };
  EXPECT_EQ(with([](auto&) {}), "");
  EXPECT_EQ(with([](auto& s) { s.centroid.place.x_px = nan; }),
            "found[1].x_px: must be finite, got nan");
  EXPECT_EQ(with([](auto& s) { s.centroid.place.x_px = -16.5; }),
            "found[1].x_px: must be from -16 to 215, got -16.5");
  EXPECT_EQ(with([](auto& s) { s.centroid.place.y_px = 115.5; }),
            "found[1].y_px: must be from -16 to 115, got 115.5");
  EXPECT_EQ(with([](auto& s) { s.centroid.covariance_px2[0] = 0; }),
            "found[1].var_x_px2: must be > 0, got 0");
  EXPECT_EQ(with([](auto& s) { s.centroid.covariance_px2[2] = 1e9; }),
            "found[1].var_y_px2: must be from 0 to 100000000, got 1e+09");
  EXPECT_THAT(with([](auto& s) { s.centroid.covariance_px2[1] = 0.06; }),
              testing::StartsWith("found[1].cov_xy_px2: must be that of a covariance"));
  EXPECT_EQ(with([](auto& s) { s.light_e = INFINITY; }),
            "found[1].flux_e: must be finite, got inf");
  EXPECT_EQ(with([](auto& s) { s.snr = 0; }), "found[1].snr: must be > 0, got 0");
  EXPECT_EQ(with([](auto& s) { s.ends->at(1).place.y_px = nan; }),
            "found[1].end2.y_px: must be finite, got nan");
  EXPECT_EQ(with([](auto& s) { s.ends->at(0).covariance_px2[2] = -1; }),
            "found[1].end1.var_y_px2: must be > 0, got -1");
  EXPECT_THAT(with([](auto& s) { s.ends->at(0) = s.ends->at(1); }),
              testing::StartsWith("found[1].end2: must be another place than end1"));
  EXPECT_THROW(check_sources(std::vector(max_measured_sources + 1, point(1, 1)), 200, 100), Error);
}

class DescribedSources : public testing::Test {
 protected:
  DetectionResult described_in_frame(std::vector<MeasuredSource> sources) {
    return described(std::move(sources), counts, header, threads);
  }

  FrameHeader header = camera_header(400, 300, 1663.0, 34 * deg, 20, true);
  Threads threads{1};
  CountImage counts = SimulatedFrame(header, 400, 300, 1500.0, 3).expose();
};

TEST_F(DescribedSources, APointIsAtItsPixelWithItsError) {
  const DetectionResult result = described_in_frame({point(100.25, 80.5)});
  ASSERT_EQ(result.detections.size(), 1u);
  const Detection& d = result.detections[0];
  EXPECT_EQ(d.id, "test/1/0");
  EXPECT_EQ(d.kind, DetectionKind::point);
  EXPECT_EQ(d.x_px, 100.25);
  EXPECT_EQ(d.y_px, 80.5);
  EXPECT_EQ(d.covariance_px2, (std::array{0.04, 0.01, 0.09}));
  const auto place = to_spherical(wcs_direction(header.wcs, {100.25, 80.5}));
  EXPECT_EQ(d.ra_rad, place[0]);
  EXPECT_EQ(d.dec_rad, place[1]);
  // Rows run to the east, columns to the north: of the pixel's size, but for the distance from the
  // axis.
  const double px_rad = 1 / 1663.0;
  EXPECT_NEAR(d.covariance_rad2[0] / (0.09 * px_rad * px_rad), 1.0, 0.02);
  EXPECT_NEAR(d.covariance_rad2[2] / (0.04 * px_rad * px_rad), 1.0, 0.02);
  EXPECT_NEAR(d.magnitude, 17.0 - 2.5 * std::log10(2000.0 / 20.0), 1e-12);
  EXPECT_NEAR(d.magnitude_sigma, 1.0857 / 40, 1e-5);
  EXPECT_EQ(d.length_px, 0.0);
  EXPECT_FALSE(d.saturated || d.at_edge || d.star_like);
}

// What detect finds, told again by pixels alone, is the same on the sky.
TEST_F(DescribedSources, AStreakIsWhereOurOwnDetectorHasIt) {
  SimulatedFrame frame(header, 400, 300, 1500.0, 5);
  frame.add_streak(200, 150, 60, 0.7, 60 * 800.0);
  const CountImage exposed = frame.expose();
  const auto own = detect(exposed, header, nullptr, threads).detections;
  ASSERT_EQ(own.size(), 1u);
  const Detection& o = own[0];
  MeasuredSource source = streak(o.end2_x_px, o.end2_y_px, o.end1_x_px, o.end1_y_px);
  source.centroid = {{o.x_px, o.y_px}, o.covariance_px2};
  source.light_e = o.signal_e;
  source.snr = o.snr;
  const auto result = described(std::vector{source}, exposed, header, threads);
  ASSERT_EQ(result.detections.size(), 1u);
  const Detection& d = result.detections[0];
  const double tolerance_rad = 0.05 / 1663.0;
  EXPECT_EQ(d.kind, DetectionKind::streak);
  EXPECT_NEAR(d.ra_rad, o.ra_rad, tolerance_rad);
  EXPECT_NEAR(d.dec_rad, o.dec_rad, tolerance_rad);
  EXPECT_NEAR(d.corrected_ra_rad, o.corrected_ra_rad, tolerance_rad);
  EXPECT_EQ(d.end1_ra_rad, o.end1_ra_rad);
  EXPECT_EQ(d.end2_dec_rad, o.end2_dec_rad);
  EXPECT_EQ(d.end1_x_px, o.end1_x_px);
  EXPECT_EQ(d.end1_time, header.start);
  EXPECT_EQ(d.end2_time, header.end);
  EXPECT_EQ(d.rate_rad_per_s, o.rate_rad_per_s);
  EXPECT_NEAR(d.length_px, o.length_px, 1e-9);
  EXPECT_NEAR(d.position_angle_rad, o.position_angle_rad, 1e-3);
  EXPECT_EQ(d.magnitude, o.magnitude);
  EXPECT_NEAR(std::sqrt(d.covariance_rad2[0] / o.covariance_rad2[0]), 1.0, 0.1);
}

TEST_F(DescribedSources, TheirOrderIsThatOfTheirSnrAndPlaces) {
  MeasuredSource bright = point(50, 60), low = point(20, 40), high = point(10, 41);
  bright.snr = 50;
  const auto one = described_in_frame({high, low, bright}).detections;
  EXPECT_EQ(one, described_in_frame({bright, high, low}).detections);
  ASSERT_EQ(one.size(), 3u);
  EXPECT_EQ(one[0].x_px, 50);
  EXPECT_EQ(one[1].x_px, 20);
  EXPECT_EQ(one[2].index, 2u);
}

TEST_F(DescribedSources, TheFrameTellsWhetherTheyAreClippedOrAtItsEdge) {
  counts.at(120, 90) = 65535;
  const auto found = described_in_frame({point(120.3, 89.8), point(1, 50), point(399, 50),
                                         streak(100, 90, 140, 90), streak(100, 92, 140, 92),
                                         streak(300, 200, 399, 200)});
  ASSERT_EQ(found.detections.size(), 6u);
  for (const Detection& d : found.detections) {
    const bool clipped = d.y_px > 89 && d.y_px < 91;
    EXPECT_EQ(d.saturated, clipped) << d.id;
    EXPECT_EQ(d.at_edge, d.x_px < 2 || d.end2_x_px > 398) << d.id;
  }
  EXPECT_EQ(found.report.saturated_px, 1u);
}

TEST_F(DescribedSources, TheReportHasTheFramesNoiseAndTheHeadersPsf) {
  const FrameReport report = described_in_frame({point(100, 100)}).report;
  EXPECT_FALSE(report.detection_off);
  EXPECT_EQ(report.detections, 1u);
  EXPECT_NEAR(report.noise_e, std::hypot(std::sqrt(1500.0), header.read_noise_e), 1.0);
  EXPECT_NEAR(report.psf_fwhm_px, header.psf_fwhm_px, 0.05);
  EXPECT_EQ(report.psf_stars, 0u);
  EXPECT_GT(report.limiting_magnitude, 5.0);
}

}  // namespace
}  // namespace dmise
