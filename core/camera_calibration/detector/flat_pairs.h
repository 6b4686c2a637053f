#pragma once
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "core/camera_calibration/detector/bias_frames.h"

namespace dmise {

/// A tile of one flat [DN above the bias].
struct FlatTile {
  float mean = 0.0f;
  float scatter = 0.0f;  // from pixel to pixel, their pattern included
};

/// A tile of two flats of the same light: what differs between them is noise alone.
struct PairTile {
  float signal = 0.0f;      // mean of both [DN above the bias]
  float variance = 0.0f;    // noise of a pixel of one flat [DN2]
  float covariance = 0.0f;  // between neighbours along rows and columns [DN2]
  float pixels = 0.0f;      // that were used
};

struct FlatPair {
  std::size_t first = 0, second = 0;  // numbers of the flats
  std::vector<PairTile> tiles;
};

/// All flats by tiles.
struct FlatTiles {
  std::vector<const CalibrationFrame*> flats;
  std::vector<std::vector<FlatTile>> tiles;  // by flats
  std::vector<FlatPair> pairs;
  double mean_of(std::size_t flat) const;
};

/// Flats less the bias's mean frame (empty: as they are), in tiles, and in pairs of neighbours in
/// the list with the same exposure and nearly the same light. Outliers are left out.
FlatTiles measure_flats(const CalibrationSet& set, const std::vector<float>& bias_mean,
                        Threads& threads);

/// Values of a flat less the bias's mean frame.
std::vector<float> light_of(const CalibrationSet& set, const CalibrationFrame& flat,
                            const std::vector<float>& bias_mean);

}  // namespace dmise
