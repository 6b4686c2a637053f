#pragma once
#include <optional>
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "core/products/detection.h"
#include "core/sequences/motion_stack.h"
#include "core/sequences/sequence_frame.h"

namespace dmise {

struct SequenceSearch {
  // Greatest rate against the detector; none: that at which a point trails by two widths of the PSF
  // in an exposure.
  std::optional<double> max_rate_rad_per_s;
  bool stack = true;  // also search below the limit of a single frame
  StackProgress progress;
};

/// Position of an object in a frame of the sequence.
struct SequencePosition {
  std::string file;
  std::uint32_t frame = 0;
  std::string time_utc;  // middle of the exposure
  double after_s = 0.0;  // the detection's time
  double x_px = 0.0, y_px = 0.0;
  double ra_rad = 0.0, dec_rad = 0.0;
  std::array<double, 3> covariance_px2{};  // var x, cov xy, var y
  double snr = 0.0;
  bool measured = false;  // in this frame alone; else it is that of the motion
  bool used = false;      // the frame shows the place, and nothing brighter there
};

/// An object that moves evenly over a sequence.
struct SequenceTrack {
  Detection detection;    // in the frame that is nearest to the middle of the sequence
  FrameHeader header;     // header of that frame
  bool by_stack = false;  // no single frame shows it
  // East and north of the sky, at the detection's time; the place in pixels of the middle frame.
  double rate_ra_rad_per_s = 0.0, rate_dec_rad_per_s = 0.0;
  std::array<double, 10> covariance{};  // place and rate, lower triangle by rows [rad2 ..]
  PixelPosition rate_px_per_s;
  std::vector<SequencePosition> positions;  // by time
};

struct SequenceResult {
  std::vector<SequenceTrack> tracks;  // by falling SNR
  std::vector<std::string> notes;     // what limited the search
};

/// Finds what moves evenly against the stars over the frames: first the points that single frames
/// show (tracklets), then along all rates together what they do not show. Without a catalogue:
/// what stays on the sky is a star. What stays on the detector is an object if it is as wide as the
/// PSF, else a hot pixel. `frames`: as `check_sequence` accepts them, in any order. Equal for any
/// number of threads. Throws `ConfigError` for frames that are no sequence, `Error` if they can't
/// be registered.
SequenceResult detect_sequence(std::vector<SequenceFrame> frames, const SequenceSearch& search,
                               Threads& threads);

}  // namespace dmise
