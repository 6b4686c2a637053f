#include "core/sequences/hot_pixels.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/quantile.h"

namespace dmise {
namespace {

constexpr double min_sigma_px = 0.7;       // below, stars are as sharp
constexpr double min_excess_sigmas = 4.5;  // over what the neighbours allow
constexpr double median_noise = 1.25;      // noise of a median over a mean's, for many values

constexpr std::size_t min_unusable = 2, frames_per_unusable = 5;

using MedianSky = Image<float, struct MedianSkyCarrier>;

/// Median of the frames' counts above their sky, in units of its noise.
MedianSky median_over_frames(const std::vector<SequenceFrame>& frames,
                             const FilteredSequence& sequence) {
  const int columns = sequence.columns;
  MedianSky median(columns, sequence.rows);
  const auto n = frames.size();
  std::vector<float> rows(n * std::size_t(columns)),
      level = std::vector<float>(std::size_t(columns)), sigma = level, values(n);
  for (int y = 0; y < sequence.rows; ++y) {
    for (std::size_t i = 0; i < n; ++i) {
      sequence.frames[i].background.level_row(y, 0, columns, level.data());
      sequence.frames[i].background.sigma_row(y, 0, columns, sigma.data());
      for (int x = 0; x < columns; ++x)
        rows[std::size_t(x) * n + i] =
            (float(frames[i].counts.at(x, y)) - level[std::size_t(x)]) / sigma[std::size_t(x)];
    }
    for (int x = 0; x < columns; ++x) {
      const auto first = rows.begin() + std::ptrdiff_t(std::size_t(x) * n);
      std::copy(first, first + std::ptrdiff_t(n), values.begin());
      std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(n / 2), values.end());
      median.at(x, y) = values[n / 2];
    }
  }
  return median;
}

/// Pixels that several frames show to be sharper than light, or otherwise not of use.
PixelMask often_unusable(const std::vector<SequenceFrame>& frames,
                         const FilteredSequence& sequence) {
  PixelMask out(sequence.columns, sequence.rows);
  const std::size_t least = std::max(min_unusable, frames.size() / frames_per_unusable);
  for (std::size_t p = 0; p < out.pixels.size(); ++p) {
    std::size_t count = 0;
    for (const SequenceFrame& frame : frames)
      count += !frame.unusable.pixels.empty() && frame.unusable.pixels[p] != 0;
    out.pixels[p] = count >= least;
  }
  return out;
}

}  // namespace

PixelMask find_hot_pixels(const std::vector<SequenceFrame>& frames,
                          const FilteredSequence& sequence) {
  PixelMask hot = often_unusable(frames, sequence);
  if (sequence.sigma_px < min_sigma_px) return hot;
  const MedianSky median = median_over_frames(frames, sequence);
  // A neighbour of the brightest pixel has at least this share of its light.
  const double share = std::exp(-0.5 / (sequence.sigma_px * sequence.sigma_px));
  const double noise =
      median_noise * std::sqrt((1 + 0.25 / (share * share)) / double(frames.size()));
  for (int y = 1; y + 1 < median.rows; ++y)
    for (int x = 1; x + 1 < median.columns; ++x) {
      const double here = double(median.at(x, y));
      const double around = double(median.at(x - 1, y) + median.at(x + 1, y) + median.at(x, y - 1) +
                                   median.at(x, y + 1)) /
                            4;
      const double error = std::hypot(noise, 0.1 * here);
      hot.at(x, y) |= here - std::max(around, 0.0) / share > min_excess_sigmas * error;
    }
  return hot;
}

}  // namespace dmise
