#pragma once
#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// A normal deviate per pixel, new in each frame. With a spread each pixel has an rms of its own
/// (CMOS), log-normal over the pixels and the same in every frame.
struct ReadNoise {
  static constexpr EffectFacts facts{"read_noise", "noise of the read-out amplifier", "none",
                                     "Janesick 2001, Scientific Charge-Coupled Devices"};
  double read_noise_e = 0.0;  // rms, of all pixels
  /// Standard deviation of the logarithm of the pixels' rms: their median is read_noise_e
  /// exp(-spread^2).
  double read_noise_spread = 0.0;
  bool operator==(const ReadNoise&) const = default;

  static std::span<const ParameterOf<ReadNoise>> parameters();
  void switch_off() { read_noise_e = read_noise_spread = 0.0; }
  bool applies(const Detector&) const { return read_noise_e > 0.0; }
  void apply(const ExposureFacts& exposed, Piece& piece) const;
  /// Whether pixels differ.
  bool is_spread() const { return read_noise_e > 0.0 && read_noise_spread > 0.0; }
  /// Rms of `count` pixels from `first` on.
  void rms_of_pixels(const RngKey& fixed_key, std::size_t first, std::span<float> rms_e) const;
  /// Its time is in that of the photons' noise.
  static ErrorBound error(int, const PlanFacts& f);
};

}  // namespace dmise
