#include "core/detection/light/psf.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/detection/detect.h"
#include "core/detection/light/trail_light.h"
#include "tests/support/simulated_frame.h"

namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;

constexpr double focal_px = 4000.0, sky_e = 1500.0, declination_rad = 34 * deg;
constexpr int side_px = 1200, cell_px = 60;

/// A star that is the sum of two Gaussians, drawn by brute force.
struct Wide {
  double fwhm_px = 1.7, wings_fwhm_px = 4.0, wings = 0.0;
};

/// Draws something with the frame's PSF set to `psf`.
template <class Draw>
void draw(SimulatedFrame& frame, const Wide& psf, double flux_e, const Draw& add) {
  const double before = frame.header().psf_fwhm_px;
  frame.header().psf_fwhm_px = psf.fwhm_px;
  add(flux_e * (1 - psf.wings));
  frame.header().psf_fwhm_px = psf.wings_fwhm_px;
  if (psf.wings > 0) add(flux_e * psf.wings);
  frame.header().psf_fwhm_px = before;
}

struct Field {
  FrameHeader header = camera_header(side_px, side_px, focal_px, declination_rad, 20, true);
  DetectionResult result;
  std::vector<PixelPosition> points;
};

/// A field with stars in two of three cells of a grid and points in the others; the header states
/// 1.7 px. `psf_at` is the PSF at a pixel.
template <class PsfAt>
Field field_of(const PsfAt& psf_at, double point_e, bool with_stars = true) {
  Field field;
  SimulatedFrame frame(field.header, side_px, side_px, sky_e, 3);
  int i = 0;
  for (int y = cell_px / 2; y < side_px; y += cell_px)
    for (int x = cell_px / 2; x < side_px; x += cell_px) {
      const double at_x = x + frame.uniform(-5, 5), at_y = y + frame.uniform(-5, 5);
      const Wide psf = psf_at(at_x, at_y);
      if (i++ % 3 == 0) {
        field.points.push_back({at_x, at_y});
        draw(frame, psf, point_e, [&](double e) { frame.add_point(at_x, at_y, e); });
      } else if (with_stars) {
        draw(frame, psf, frame.uniform(20000, 150000),
             [&](double e) { frame.add_star(at_x, at_y, e); });
      }
    }
  Threads threads;
  field.result = detect(frame.expose(), field.header, {}, threads);
  return field;
}

/// Mean of measured over true electrons of points.
double mean_flux_ratio(const Field& field, double point_e) {
  double sum = 0.0;
  int n = 0;
  for (const Detection& d : field.result.detections)
    for (const PixelPosition& p : field.points)
      if (std::hypot(d.x_px - p.x_px, d.y_px - p.y_px) < 3) {
        sum += d.signal_e / point_e;
        ++n;
      }
  EXPECT_GE(n, int(field.points.size()) * 9 / 10);
  return sum / std::max(n, 1);
}

TEST(MeasuredPsf, WidthIsThatOfTheStarsNotOfTheHeader) {
  const Field field = field_of([](double, double) { return Wide{.fwhm_px = 2.6}; }, 20000);
  EXPECT_GE(field.result.report.psf_stars, 50u);
  EXPECT_NEAR(field.result.report.psf_fwhm_px, 2.6, 0.02);
  EXPECT_NEAR(mean_flux_ratio(field, 20000), 1.0, 0.01);
}

// A fifth of the light in wings of twice the width; the header's Gaussian finds 10 % less.
TEST(MeasuredPsf, WingsCount) {
  const Wide psf{.fwhm_px = 1.8, .wings_fwhm_px = 4.0, .wings = 0.2};
  const Field field = field_of([&](double, double) { return psf; }, 20000);
  EXPECT_GE(field.result.report.psf_stars, 50u);
  EXPECT_NEAR(mean_flux_ratio(field, 20000), 1.0, 0.01);
}

TEST(MeasuredPsf, WidthMayChangeOverTheFrame) {
  const Field field = field_of(
      [](double x, double y) {
        const double r2 = std::pow(x / side_px - 0.5, 2) + std::pow(y / side_px - 0.5, 2);
        return Wide{.fwhm_px = 1.7 * (1 + 1.4 * r2)};
      },
      20000);
  EXPECT_GE(field.result.report.psf_stars, 50u);
  EXPECT_NEAR(field.result.report.psf_fwhm_px, 1.7, 0.03);  // in the middle
  EXPECT_NEAR(mean_flux_ratio(field, 20000), 1.0, 0.01);
}

TEST(MeasuredPsf, WithoutStarsItIsTheHeaders) {
  const Field field = field_of([](double, double) { return Wide{}; }, 20000, false);
  EXPECT_EQ(field.result.report.psf_stars, 0u);
  EXPECT_NEAR(field.result.report.psf_fwhm_px, field.header.psf_fwhm_px, 1e-12);
}

Psf mixture() {
  Psf psf;
  psf.count = 3;
  psf.parts = {{{1.3, 0.9}, {-0.5, 1.4}, {0.2, 3.0}}};
  return psf;
}

TEST(TrailLight, MixtureSumsToTheFlux) {
  for (const double length : {0.0, 20.0}) {
    const Trail trail{40.2, 40.7, 1000.0, length, 0.4};
    double sum = 0.0;
    for (int y = 0; y < 81; ++y)
      for (int x = 0; x < 81; ++x) sum += trail_value(trail, mixture(), x, y);
    EXPECT_NEAR(sum, 1000.0, 0.5) << length;
  }
}

TEST(TrailLight, DerivativesAreThoseOfDifferences) {
  const Trail trail{10.2, 9.7, 1000.0, 12.0, 0.4, 0.2, 0.3};
  double Trail::*const members[] = {&Trail::x_px,      &Trail::y_px,      &Trail::flux_e,
                                    &Trail::length_px, &Trail::angle_rad, &Trail::slope,
                                    &Trail::sagitta_px};
  for (const PixelPosition at : {PixelPosition{10, 10}, {14, 11}, {5, 9}}) {
    TrailDerivatives by{};
    TrailLight(trail, mixture())(at.x_px, at.y_px, by);
    for (std::size_t i = 0; i < trail_parameters; ++i) {
      const double step = 1e-4;
      Trail up = trail, down = trail;
      up.*members[i] += step;
      down.*members[i] -= step;
      const double difference = trail_value(up, mixture(), at.x_px, at.y_px) -
                                trail_value(down, mixture(), at.x_px, at.y_px);
      EXPECT_NEAR(by[i], difference / (2 * step), 1e-3 + 1e-4 * std::abs(by[i])) << i;
    }
  }
}

/// Axes of 0.8 to 1, turned by 0.45 rad.
Psf ellipse() {
  Psf psf = mixture();
  psf.along_x = 0.13;
  psf.along_diagonal = 0.17;
  return psf;
}

/// The normal distribution of two variables, of each part.
double normal_density(const Psf& psf, double x, double y) {
  double sum = 0.0;
  for (std::size_t k = 0; k < psf.count; ++k) {
    const double all = psf.parts[k].sigma_px * psf.parts[k].sigma_px;
    const double optical = all - pixel_variance_px2;
    const double xx = all + optical * psf.along_x, yy = all - optical * psf.along_x;
    const double xy = optical * psf.along_diagonal, determinant = xx * yy - xy * xy;
    sum += psf.parts[k].weight *
           std::exp(-0.5 * (x * x * yy - 2 * x * y * xy + y * y * xx) / determinant) /
           (2 * pi * std::sqrt(determinant));
  }
  return sum;
}

TEST(TrailLight, OfAnEllipseIsTheNormalDistributionAlongTheLine) {
  Psf psf = ellipse();
  for (auto& part : psf.parts) part.sigma_px += 0.3;  // no term for the pixel's square
  constexpr int steps = 2000;
  for (const double length : {0.0, 7.0})
    for (const double angle : {0.0, 0.7, 2.0}) {
      const Trail trail{10.2, 9.7, 1000.0, length, angle};
      for (const PixelPosition at : {PixelPosition{10, 10}, {12, 9}, {7, 12}}) {
        double sum = 0.0;
        for (int i = 0; i < steps; ++i) {
          const double along = ((i + 0.5) / steps - 0.5) * length;
          sum += normal_density(psf, at.x_px - trail.x_px - along * std::cos(angle),
                                at.y_px - trail.y_px - along * std::sin(angle));
        }
        EXPECT_NEAR(trail_value(trail, psf, at.x_px, at.y_px), 1000 * sum / steps, 1e-3)
            << length << " px at " << angle;
      }
    }
}

TEST(TrailLight, DerivativesOfAnEllipseAreThoseOfDifferences) {
  const Trail trail{10.2, 9.7, 1000.0, 12.0, 0.4, 0.2, 0.3};
  double Trail::*const members[] = {&Trail::x_px, &Trail::y_px, &Trail::flux_e, &Trail::length_px};
  for (const PixelPosition at : {PixelPosition{10, 10}, {14, 11}, {5, 9}}) {
    TrailDerivatives by{};
    TrailLight(trail, ellipse())(at.x_px, at.y_px, by);
    for (std::size_t i = 0; i < std::size(members); ++i) {
      const double step = 1e-4;
      Trail up = trail, down = trail;
      up.*members[i] += step;
      down.*members[i] -= step;
      const double difference = trail_value(up, ellipse(), at.x_px, at.y_px) -
                                trail_value(down, ellipse(), at.x_px, at.y_px);
      EXPECT_NEAR(by[i], difference / (2 * step), 1e-3 + 1e-4 * std::abs(by[i])) << i;
    }
  }
}

// The sum of squares of a Gaussian is 1 / (4 pi sigma^2).
TEST(Psf, EquivalentWidthHasTheSumOfSquares) {
  for (const Psf& psf : {mixture(), ellipse()}) {
    const Trail point{60, 60, 1.0};
    double squares = 0.0;
    for (int y = 0; y < 480; ++y)
      for (int x = 0; x < 480; ++x) {
        const double v = trail_value(point, psf, 0.25 * x, 0.25 * y);
        squares += v * v / 16;
      }
    EXPECT_NEAR(psf.equivalent_sigma_px(), 1 / std::sqrt(4 * pi * squares), 1e-4);
  }
}

}  // namespace
}  // namespace dmise
