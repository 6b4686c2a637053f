#pragma once
#include <vector>

#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// Smear of a shutterless CCD: the image is shifted under the mask, towards row 0, while it is
/// still exposed. A pixel gains the light of every row that it passes, times the shift time per row
/// over the exposure time. Pixel response is not applied to that gain.
struct FrameTransfer {
  static constexpr EffectFacts facts{
      "frame_transfer", "the image is still exposed while it is shifted under the mask",
      "no smear: the light of the rows passed, times a row's time over the exposure",
      "Ruyten 1999, Opt. Lett. 24, 878"};
  double frame_transfer_s = 0.0;  // time to shift all rows; 0: a shutter, no smear
  bool operator==(const FrameTransfer&) const = default;

  static std::span<const ParameterOf<FrameTransfer>> parameters();
  void switch_off() { frame_transfer_s = 0.0; }
  bool applies(const Detector&) const { return frame_transfer_s > 0.0; }
  /// Light of the rows before every `rows_a_sum`th, by column [e-].
  using Prepared = std::vector<double>;
  Prepared prepare(const ExposureFacts& exposed) const { return sums_of(exposed.light); }
  void apply(const ExposureFacts& exposed, const Prepared& sums, Piece& piece) const;
  static ErrorBound error(int, const PlanFacts&) { return not_bounded; }
  static double cost_s(int level, const PlanFacts& f);
  /// Returns a whole image with its smear.
  ExpectedElectronImage smeared(const ExpectedElectronImage& light, const Exposure& exposure) const;

 private:
  Prepared sums_of(const ExpectedElectronImage& light) const;
  void add(const ExpectedElectronImage& light, const Exposure& exposure, const Prepared& sums,
           std::size_t first, std::span<float> electrons) const;
};

}  // namespace dmise
