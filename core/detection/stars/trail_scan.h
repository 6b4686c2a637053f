#pragma once
#include <array>
#include <span>
#include <vector>

#include "core/detection/source/residual_frame.h"

namespace dmise {

/// A place in a frame where a star's trail may have its middle. By rising score.
struct TrailPlace {
  double score = 0.0;  // SNR of the light along the trail
  double x_px = 0.0, y_px = 0.0;
  bool is_second_try = false;

  bool operator<(const TrailPlace& other) const { return score < other.score; }
};

/// Light along the trails that stars have at each place of a residual frame, which has its SNR of
/// points. Scores leave out a trail's brightest quarter, which may be of something else.
class TrailScan {
 public:
  TrailScan(const Scene& scene, const ResidualFrame& residual);

  /// Places with the highest score around them, of at least about `min_snr`. They may be beside
  /// the frame.
  std::vector<TrailPlace> peaks(double min_snr) const;
  /// Pixels that `peaks` reads.
  double reads_of_peaks() const;
  /// Moves to the highest score around, by steps along and across the trail. Returns how many
  /// pixels it has read.
  double climb(TrailPlace& place) const;

  /// Mean SNR of points over a part of a trail's line, and its noise.
  struct Part {
    double mean = 0.0, noise = 0.0;
    int samples = 0;
  };
  Part part_of(const Trail& trail, double from_px, double to_px) const;
  /// What that mean is far from a trail's ends.
  double level_of(const Trail& trail) const;
  /// Width of a trail's light in the filtered frame.
  double filtered_sigma_px(const Trail& trail) const;

 private:
  double score_at(double x, double y, const Trail& trail) const;
  double score_of(const std::array<double, 4>& sum, const std::array<int, 4>& count,
                  int samples) const;
  void score_row(double x, double y, const Trail& trail, std::span<float> scores) const;

  const Scene& scene_;
  const ResidualFrame& residual_;
  double longest_px_;             // trail in the frame
  PixelPosition beside_px_;       // how far beside the frame middles are searched
  std::vector<double> variance_;  // for sums of so many pixels along a line
};

}  // namespace dmise
