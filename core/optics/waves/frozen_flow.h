#pragma once
#include <cstdint>
#include <limits>

#include "core/optics/waves/phase_screen.h"

namespace dmise {

/// Turbulence that the wind moves across an aperture as a frozen screen. The phase is a function of
/// time alone, in any order of calls; only the last screens drawn are cached.
///
/// The window slides over the periodic torus of `KolmogorovScreens` in whole samples. Over each
/// `fading_length` it blends from one torus to the next with weights cos and sin, so that the
/// expected structure function is always that of one screen, and frames closer than the window are
/// correlated. A torus is replaced before the window has travelled around it in any direction, so
/// the phase never repeats.
class FrozenFlow {
 public:
  /// `side` samples of the window; `outer_scale` in samples; `key` identifies the sensor's
  /// turbulence.
  FrozenFlow(int side, double outer_scale, const RngKey& key);

  int torus() const { return screens_.torus(); }
  /// Samples over which one torus blends into the next: half of the torus minus the window.
  int fading_length() const { return length_; }

  /// The window after the screen has moved by `distance` samples (any, also negative) towards
  /// `direction_rad`, from +x to +y; r0 in samples.
  PhaseScreen at(double distance, double direction_rad, double r0_samples);

 private:
  struct Field {
    std::int64_t block = std::numeric_limits<std::int64_t>::min();
    std::vector<float> phase;  // torus x torus, for r0 of one sample
    KolmogorovScreens::Tilt tilt;
  };
  const Field& field(std::int64_t block);

  KolmogorovScreens screens_;
  int length_;
  RngKey key_;
  Field kept_[4];
};

}  // namespace dmise
