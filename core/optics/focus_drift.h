#pragma once
#include <span>
#include <string_view>

#include "core/effects/effects.h"

namespace dmise {

/// The detector leaves the focus in which the run begins: with time, and with the temperature,
/// which goes up and down once a day. It is a wavefront for a pupil, a disc for a Gaussian (a ring
/// with an obscuration) of defocus / focal ratio.
struct FocusDrift {
  static constexpr EffectFacts facts{"focus_drift", "the focus drifts with time and temperature",
                                     "the focus stays: a disc of defocus / focal ratio is missing",
                                     "Smith 2008, Modern Optical Engineering"};
  static bool applies(const SceneFacts& scene) { return scene.focus_drifts; }
  static ErrorBound error(int level, const PlanFacts& f);
  /// Kernels of each exposure.
  static double cost_s(int level, const PlanFacts& f);

  double start_um = 0.0;  // along the axis, at the start of the run
  double um_per_hour = 0.0;
  double um_per_k = 0.0;
  double swing_k = 0.0;     // between the daily extremes of the temperature
  double warmest_h = 14.0;  // from the start of the run
  double run_s = 0.0;       // length of the run

  bool any() const { return start_um != 0.0 || um_per_hour != 0.0 || um_per_k * swing_k != 0.0; }
  /// Defocus at a time of the run [m].
  double at_m(double time_s) const;
  /// Its largest size in the run [m].
  double max_m() const;
  bool operator==(const FocusDrift&) const = default;
};

/// A parameter of it, for YAML, digests, `dmise check` and documents.
struct FocusParameter {
  std::string_view key;
  std::string_view meaning;  // with the unit
  double FocusDrift::*value;
  double least, most;
};
std::span<const FocusParameter> focus_parameters();

}  // namespace dmise
