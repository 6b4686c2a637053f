#pragma once
#include <array>
#include <optional>
#include <vector>

#include "core/base/pixel.h"
#include "core/sequences/moving_light.h"
#include "core/sequences/sky_motion.h"

namespace dmise {

/// A track in one frame.
struct TrackPoint {
  std::size_t frame = 0;
  PixelPosition place;    // where the motion is, in the frame
  double snr = 0.0;       // for a point there
  double expected = 0.0;  // by the track's light
  bool used = false;      // by the fit: the place is known, and not by chance on something brighter
  // Place by its light alone, where the frame shows it; else that of the motion.
  std::optional<PixelPosition> measured;
  std::array<double, 3> covariance_px2{};  // errors of `measured`: var x, cov xy, var y
};

/// Covariance of place, rate and acceleration of a motion (x, y, x', y', x'', y'').
using MotionCovariance = std::array<std::array<double, 6>, 6>;

/// An object that moves evenly over the frames of a sequence.
struct MovingTrack {
  SkyMotion motion;
  MotionCovariance covariance{};
  double amplitude_e = 0.0;  // through the filter, in the reference frame
  double snr = 0.0;          // all frames together
  std::vector<TrackPoint> points;
  std::size_t used() const;
};

/// What a fit of tracks reads.
struct TrackScene {
  const FilteredSequence& sequence;
  const Registration& registration;
  const MotionRange& range;
  std::vector<MovingLight>& light;  // tracks that were found are taken out
};

/// Greatest light of a source in one frame that counts, so that none makes a track alone.
inline constexpr double max_snr_of_frame = 5.0;

/// Value of an image of SNRs and its slopes at a place, by cubic interpolation.
struct SnrAt {
  double snr = 0.0, weight = 0.0;  // weight 0: not known
  PixelPosition slope;             // [1/px]
};
SnrAt snr_at(const MovingLight& light, PixelPosition place);

/// Fits motion and light by maximum likelihood to the frames through the matched filter. The range
/// gives the prior of the acceleration. Empty if
/// it leaves the start by more than a few widths of the PSF or is in fewer than three frames.
std::optional<MovingTrack> fit_track(const TrackScene& scene, const SkyMotion& start);

/// SNR of a track, of which no frame counts for more than `max_snr_of_frame`; without its
/// `best_left_out` best frames.
double steady_snr(const MovingTrack& track, std::size_t best_left_out);

/// The covariance of place, rate and acceleration at another time.
MotionCovariance covariance_at(const MovingTrack& track, double time_s);

}  // namespace dmise
