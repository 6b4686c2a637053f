#pragma once
#include <string>
#include <vector>

#include "core/base/pixel.h"
#include "core/effects/accuracy.h"
#include "sensors/accuracy/scene_frames.h"

namespace dmise {

/// A star or object of the reference frame, in a capsule of three point spreads around its trail.
struct ReferenceSource {
  bool whole = false;   // its capsule is within the frame
  bool alone = false;   // no other source's light is in its capsule
  bool counts = false;  // bright, whole, alone and not saturated: errors are its own
  std::string name;
  std::vector<PixelPosition> trail;  // corners of a line along it
  double margin_px = 0.0;            // around it
  double light_e = 0.0;              // in the capsule
  double peak_sigma = 0.0;           // in its brightest pixel, in the noise there
  PixelPosition centroid;            // weighted by its light
  double snr = 0.0;                  // by a matched filter
};

/// What a frame lacks of the reference.
struct FrameError {
  ErrorBound largest;           // background and the sources that count
  double residual_sigma = 0.0;  // rms of the difference of all pixels, in their noise
};

/// Compares frames of one exposure with its reference, by what they expect of every pixel:
/// docs/accuracy.md gives the definitions.
class FrameComparison {
 public:
  /// `reference`: as `SceneFrames::make` gives it, with the levels of its effects.
  FrameComparison(const SceneFrames& scene, const FrameProducts& reference,
                  const EffectSet& effects);

  const std::vector<ReferenceSource>& sources() const { return sources_; }
  FrameError error_of(const FrameProducts& frame, const EffectSet& effects) const;
  /// Returns how many pixels count as background.
  std::size_t background_pixels() const;

 private:
  struct Expected {
    ElectronImage signal, sky, noise;
  };
  Expected expected(const FrameProducts& frame, const EffectSet& effects) const;
  void find_rounding();
  void find_sources(const FrameProducts& reference);
  void measure(ReferenceSource source);
  void leave_out_crowded();
  double skewness_error(const EffectSet& effects) const;

  const SceneFrames& scene_;
  EffectSet effects_;
  double full_e_ = 0.0;  // in brighter pixels errors do not count
  ExpectedElectronImage light_;
  Expected reference_;
  std::vector<float> sigma_e_;     // sqrt(light + dark + read^2) of each pixel
  std::vector<float> rounding_e_;  // error by single precision of each row's pixels
  std::vector<bool> background_;
  std::vector<ReferenceSource> sources_, faint_;  // faint: their capsules are background
};

}  // namespace dmise
