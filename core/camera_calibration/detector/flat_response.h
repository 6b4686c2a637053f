#pragma once
#include <vector>

#include "core/camera_calibration/detector/dark_frames.h"
#include "core/camera_calibration/detector/lens_light.h"
#include "core/camera_calibration/detector/photon_transfer.h"

namespace dmise {

/// How evenly a detector and its lens respond to even light.
struct FlatResponse {
  int frames = 0;
  MeasuredValue prnu;             // rms of the pixels' responses, relative
  std::vector<FieldLight> field;  // by rising radius; of the light, however even it is
  /// Response of each pixel beside that of its tile, as well as noise lets it be known; 1 where it
  /// is not. Empty without flats.
  std::vector<float> pixels;
};

/// Measures flats below saturation. Large scales are vignetting, what differs within a tile is the
/// pixels' response: the covariance of two halves of the flats, in which noise has no part.
/// `dark` (null: none) is taken off; hot pixels are left out. Deviations hold that of the coupling,
/// {0, 0} if there is none.
FlatResponse measure_response(const CalibrationSet& set, const FlatTiles& flats,
                              const Saturation& saturation, const BiasMeasurement& bias,
                              const DarkMeasurement* dark, double loss_per_dn,
                              MeasuredValue coupling);

}  // namespace dmise
