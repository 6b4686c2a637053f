#pragma once
#include <optional>
#include <vector>

#include "core/astrometry/plate_fit.h"
#include "core/astrometry/plate_match.h"
#include "core/astrometry/plate_model.h"
#include "core/camera_calibration/detector/jackknife.h"

namespace dmise {

/// Stars of one frame with their directions, and about where it points.
struct LensFrame {
  Rotation<CameraFrame, Gcrs> camera_from_gcrs;
  std::vector<PlateMatch> matches;
};

/// A lens by the stars of all frames, with its axis in the middle of the frame as a camera file has
/// it: one focal length and one distortion for all, an attitude for each.
struct LensFit {
  Projection projection;
  MeasuredValue focal_length_px;
  std::vector<MeasuredValue> coefficients;  // distortion as fitted, from the first term on
  bool distorted = false;                   // whether the stars show it: else `projection` has none
  double rms_px = 0.0;
};

/// Fits a lens without distortion, and with the radial terms that the stars show at 3.1 sigma: of
/// `brown_conrady` if `projection` is gnomonic, else of `kannala_brandt`. Deviations are by the
/// scatter of the stars, widened where frames differ by more. Empty if the stars do not determine
/// it.
std::optional<LensFit> fit_lens(const std::vector<LensFrame>& frames, const Projection& projection,
                                double focal_length_px, int columns, int rows);

}  // namespace dmise
