#pragma once
#include <optional>

#include "core/effects/effects.h"

namespace dmise {

/// Heat of the telescope and of the camera's window, as the detector sees it behind a cold stop:
/// the beam alone. Both are grey and radiate before the optics' transmission.
struct ThermalOptics {
  static constexpr EffectFacts facts{
      "thermal_optics", "heat of the telescope and the window, in bands that reach beyond 1.9 um",
      "beyond 3 um, at 280 K and an emissivity of 0.1, as much background as the sky's",
      "Planck's law and Kirchhoff's"};
  static bool applies(const SceneFacts& scene) { return scene.warm_optics; }
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  double emissivity = 0.0, window_emissivity = 0.0;  // 0..1
  /// [deg C]; none: those of the air at the site.
  std::optional<double> temperature_c, window_temperature_c;

  bool any() const { return emissivity > 0.0 || window_emissivity > 0.0; }
};

}  // namespace dmise
