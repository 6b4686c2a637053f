#pragma once
#include <optional>
#include <vector>

#include "core/camera_calibration/detector/flat_pairs.h"

namespace dmise {

/// How much light of flats a detector holds [DN above the bias].
struct Saturation {
  std::optional<MeasuredValue> level;  // count of full pixels; empty if no flat shows it
  std::vector<char> usable;            // whether all tiles of a flat are below
  int saturated = 0;                   // flats that are not
  /// Whether a tile of a flat is below, with all its pixels.
  bool holds(const FlatTile& tile) const {
    return tile.mean > 0 && (!level || double(tile.mean) + 6 * double(tile.scatter) < level->value);
  }
};

/// Loss of signal by the ramp of exposures: S = x (1 - loss x), x the signal of a straight
/// response.
struct Linearity {
  std::optional<MeasuredValue> loss_per_dn;
  int frames = 0;
  double unsteady = 0.0;  // relative rms of the lamp, where it is significant
};

/// Gain and coupling by the noise of flats (photon transfer: Janesick 2007).
struct PhotonTransfer {
  std::optional<MeasuredValue> gain_e_per_dn;
  MeasuredValue coupling;         // share of signal that each neighbour sees
  double shortfall_per_dn = 0.0;  // by which variance falls behind a straight line, relative
  int frames = 0;
  double lowest_dn = 0.0, highest_dn = 0.0;  // signals of the pairs
};

/// Share of a pixel's variance by light that coupling leaves.
double share_of_own_noise(double coupling);

/// `floor_variance`: of a pixel without light [DN2].
Saturation find_saturation(const FlatTiles& flats, const Tiles& tiles, double floor_variance);

/// Takes 4 flats of 3 times or more, of which the longest is 3 times the shortest.
Linearity measure_linearity(const FlatTiles& flats, const Tiles& tiles,
                            const Saturation& saturation, double floor_variance);

/// Takes a pair of flats. With four levels or more, a curvature of variance against signal, as by
/// charge that repels charge, is fitted beside the gain. `mosaic`: neighbours lie apart.
PhotonTransfer measure_gain(const FlatTiles& flats, const Tiles& tiles,
                            const Saturation& saturation, const Linearity& linearity,
                            double floor_variance, bool mosaic);

}  // namespace dmise
