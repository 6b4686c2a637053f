#pragma once
#include <cstdint>

#include "core/optics/phase_screen.h"

namespace dmise {

/// Turbulence that the wind carries past an aperture as a frozen screen. Any time may be asked for
/// in any order and gives the same phase: nothing is remembered but the last screens drawn.
///
/// The window slides over the periodic torus of `KolmogorovScreens`, in whole samples; over each
/// `fading_length` it fades from one torus to the next as cos and sin, so that the expected
/// structure function is at every time that of one screen and frames less than the window apart are
/// correlated. A torus fades in and out again before the window has come around it, whatever the
/// direction: nothing repeats.
class FrozenFlow {
 public:
  /// `side` samples a window; `outer_scale` in samples; `key` names the sensor's turbulence.
  FrozenFlow(int side, double outer_scale, const RngKey& key);

  int side() const { return screens_.side(); }
  int torus() const { return screens_.torus(); }
  /// Samples over which one torus fades into the next, half of the torus less the window.
  int fading_length() const { return length_; }

  /// The window after the screen has moved by `distance` samples (any, also negative) towards
  /// `direction_rad` from +x to +y; r0 in samples.
  PhaseScreen at(double distance, double direction_rad, double r0_samples);

 private:
  struct Field {
    std::int64_t block = -1;
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
