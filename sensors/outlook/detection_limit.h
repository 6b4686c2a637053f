#pragma once
#include <optional>

#include "sensors/pipeline/view.h"

namespace dmise {

/// Light that stands out of the noise.
struct DetectionLimit {
  double point_e = 0.0;                 // electrons of a point in the exposure
  std::optional<double> found_point_e;  // of one that is told from stars, in half of all frames
  double streak_e_per_px = 0.0;         // electrons a pixel of its length of a streak ...
  double streak_px = 0.0;               // ... of this length
};

/// SNR of the matched filter that a point's fit must reach, and a pixel of a streak in the frame
/// filtered for points (`DetectorSettings`).
inline constexpr double point_limit_snr = 6.0, streak_limit_snr = 5.0;

/// For pixels of `noise_e` rms without the source, and the Gaussian `sigma_px` that pixels see.
///
/// A point of N electrons has SNR N / sqrt(N + A noise^2), where A is one over the sum of the
/// squares of its shares of light in the pixels. A streak of density d has SNR d / noise at every
/// place of its length in the frame filtered for points; of the L / (2 sqrt(pi) sigma) places that
/// are independent the highest is above the threshold in half of all frames. Its whole must reach
/// the point's SNR as well.
///
/// A point is told from stars' trails of `star_px`, if they are long enough at all, by its shape:
/// the trail fits it worse by SNR^2 (1 - r^2), where r is the correlation of both shapes, and that
/// must reach the search's margin (`DetectorSettings::blend_margin`).
DetectionLimit detection_limit(double noise_e, double sigma_px, double streak_px, double star_px);

/// Shorter streaks are told from a few stars in a row by their shape, which takes more light than
/// is told here.
inline constexpr double shortest_streak_px = 16.0;

/// Background of the frame's centre, without any source, and what it fluctuates by.
struct PixelBackground {
  double electrons = 0.0;  // expected: sky and dark current
  double noise_e = 0.0;    // from frame to frame
};
PixelBackground background_at_centre(const View& view, double drawn_to_v_mag);

}  // namespace dmise
