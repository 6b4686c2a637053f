#pragma once
#include "core/detector/noise/detector_effect.h"

namespace dmise {

/// Charge in a pixel repels what comes after: the boundaries of pixels move towards it, by a length
/// that is proportional to the charge, and bright sources grow. A boundary moves by the sum over
/// the charges of the pixels within three of it, each along its direction and by a power of its
/// distance; what it sweeps over an exposure is half of its last displacement times the mean
/// charge of both pixels. Charge is conserved; none crosses the frame's edge.
struct BrighterFatter {
  static constexpr EffectFacts facts{
      "brighter_fatter", "charge moves the boundaries of its pixel, and bright sources are wider",
      "widths of sources near the full well too small by about 1 %",
      "Antilogus et al. 2014, JINST 9, C03048; Guyonnet et al. 2015, A&A 575, A41"};
  double brighter_fatter_per_e = 0.0;  // boundaries move by a pixel's own charge [px/e-]; 0: none
  bool operator==(const BrighterFatter&) const = default;

  static std::span<const ParameterOf<BrighterFatter>> parameters();
  static std::optional<DetectorFault> fault(const Detector& detector);
  void switch_off() { brighter_fatter_per_e = 0.0; }
  bool applies(const Detector&) const { return brighter_fatter_per_e > 0.0; }
  void apply(const ExposureFacts& exposed, const ElectronImage& electrons, Piece& piece) const;
  static ErrorBound error(int, const PlanFacts&) { return not_bounded; }
  static double cost_s(int level, const PlanFacts& f);
};

}  // namespace dmise
