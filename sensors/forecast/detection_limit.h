#pragma once
#include <optional>

#include "core/optics/range_defocus.h"
#include "core/sky/faint_starlight.h"
#include "sensors/scene/view.h"

namespace dmise {

/// Faintest detectable light.
struct DetectionLimit {
  double point_e = 0.0;  // electrons of a point in the exposure, at the limiting magnitude
  std::optional<double> found_point_e;  // point told from stars in half of all frames
  double streak_e_per_px = 0.0;         // electrons per pixel of length of a streak ...
  double streak_px = 0.0;               // ... of this length
};

/// Required SNR of the fit of a point or a whole streak, and of the brightest place of a streak in
/// the frame filtered for points (core/detection/pixels/detection_limits.h).
inline constexpr double point_limit_snr = 6.0, streak_limit_snr = 5.0;

/// For pixels of `noise_e` rms without the source, and the Gaussian `sigma_px` including the pixel.
///
/// The limiting magnitude is that of `limiting_point_e`. A point of N electrons has the fit's SNR
/// N / sqrt(N + A noise^2), where A is the inverse of the sum of squares of its fractions of light
/// in the pixels. A streak of density d has SNR d / noise
/// everywhere along its length in the frame filtered for points; the maximum of the L / (2 sqrt(pi)
/// sigma) independent positions is above the threshold in half of all frames, and the whole streak
/// reaches the point's SNR. Or the whole streak reaches `min_streak_snr`, without such a
/// position.
///
/// A point is distinguished from star trails of `star_px`, if they are long enough, by its shape:
/// the trail fits it worse by SNR^2 (1 - r^2), where r is the correlation of both shapes, which
/// must reach the margin `detection_limits::blend_margin`.
DetectionLimit detection_limit(double noise_e, double sigma_px, double streak_px, double star_px);

/// Shorter streaks are distinguished from a few stars in a row by shape, which needs more light
/// than stated here.
inline constexpr double shortest_streak_px = 16.0;

/// Background at the frame's centre, without sources, and its fluctuation.
struct PixelBackground {
  double electrons = 0.0;  // expected: sky and dark current
  double noise_e = 0.0;    // from frame to frame
};
PixelBackground background_at_centre(const View& view, const DrawnStars& drawn);

/// Noise [e-] of a pixel with `sky_e` expected electrons of sky: the median of a few pixels,
/// because some are hot.
double noise_over_sky_e(const SensorConfig& sensor, const FrameTimes& times, std::uint64_t seed,
                        double sky_e);

/// Electrons at which a pixel is full: of its well or its converter, whichever is less.
double saturation_e(const Detector& acting);

/// Gaussian width of a point in a sensor's frames, including the pixel.
double blur_sigma_px(const SensorConfig& sensor);

/// Width of a point by its range, which may be out of focus.
class BlurByRange {
 public:
  explicit BlurByRange(const SensorConfig& sensor);

  /// Diameter of its disc of defocus [px]; 0: it is as sharp as stars.
  double disc_px(double range_m) const;
  /// Deviation along an axis, including the pixel.
  double sigma_px(double range_m) const;

 private:
  Optics optics_;
  double stars_sigma_px_;
  double step_;  // share of light that may be misplaced; 1: no notice is taken of the range
  DefocusScale scale_;
};

}  // namespace dmise
