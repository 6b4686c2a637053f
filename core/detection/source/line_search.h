#pragma once
#include <cstdint>
#include <vector>

#include "core/detection/light/trail_fit.h"
#include "core/detection/pixels/filtered_frame.h"
#include "core/detection/pixels/turned_frame.h"
#include "core/detection/source/line_kernels.h"

// Sums of a filtered frame along trails. Hidden pixels and those beside the frame count neither as
// light nor as noise.
namespace dmise {

/// Sum along a trail, its noise, and in how many rows or columns it was taken.
struct LineSum {
  double sum = 0.0, noise = 0.0;
  int samples = 0;  // rows or columns that are not hidden
  int slices = 0;   // all of them in the frame
};

LineSum sum_along(const FilteredFrame& frame, const Trail& trail);

/// The sum in units of its noise: the SNR of a streak of that shape.
double snr_along(const FilteredFrame& frame, const Trail& trail);

/// What of a trail is varied.
enum class TrailChange : std::uint8_t { offset, direction, first_end, last_end, curvature };

/// A trail with one of these changed by `by_px`: ends along it, the others across.
Trail changed(Trail trail, TrailChange what, double by_px);

/// The trail near `start` along which `snr_along` is largest, by steps of its offset, direction,
/// ends and curvature; only by the first two where these find less than `min_snr`.
Trail climbed(const FilteredFrame& frame, const Trail& start, double min_snr = 5.2);

/// Memory for the sums of lines beside each other, which is used again.
struct LineBand {
  std::vector<std::int32_t> sum, samples;
  std::vector<std::int16_t> part, part_count;
  std::vector<std::int8_t> row;

  /// `has_odd`: whether lines between every second one are summed.
  BandSums of(int reach, bool has_odd = true);
};

/// Lines parallel to a trail: the median of their SNRs, at least 0, and their scatter, at least 1.
/// Where faint stars are dense or the sky is uneven, both exceed those of noise. The scatter is
/// that of the upper half, because stars only add light.
struct ParallelLines {
  double median = 0.0, scatter = 1.0;
};

ParallelLines parallel_lines(const FilteredFrame& frame, const TurnedFrame& turned,
                             const Trail& trail, LineBand& band);

}  // namespace dmise
