#pragma once
#include "core/base/sim_time.h"
#include "core/frames/vec.h"
#include "core/instrument/instrument_effect.h"

namespace dmise {

/// Where a camera truly points, in the axes of the image that was commanded: its boresight is
/// displaced by `x` to the right and `y` down, along one great circle, and it is turned
/// right-handed about that boresight by `roll`. Stars are displaced to the opposite side.
struct PointingError {
  static constexpr EffectFacts facts{
      "pointing_error", "the camera points elsewhere than it is told to",
      "bias, drift and jitter as they are given; the drift smears what the shutter sees of it",
      "rotation of the camera, with a normal deviate an exposure"};
  ImageAxes bias_rad{};
  ImageAxes drift_rad_per_s{};   // from the start of the run on
  ImageAxes pointing_rms_rad{};  // jitter, drawn anew for each exposure
  bool operator==(const PointingError&) const = default;

  static std::span<const InstrumentParameter> parameters();
  bool applies() const { return *this != PointingError{}; }
  /// Returns the angular speed of a drift, at most.
  double drift_size_rad_per_s() const;
  static ErrorBound error(int level, const PlanFacts& f);

  /// Returns x, y and roll at the true time `t`; `deviate`: jitter of the exposure in units of its
  /// rms.
  ImageAxes at_rad(SimTime t, const ImageAxes& deviate) const;
};

/// Returns the rotation to the axes of a camera that is displaced by x, y and roll [rad].
Rotation<CameraFrame, CameraFrame> true_from_commanded(const ImageAxes& displaced_rad);

}  // namespace dmise
