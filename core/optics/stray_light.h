#pragma once
#include <vector>

#include "core/effects/effects.h"

namespace dmise {

/// Light of Sun, Moon and the lit Earth beside the field that baffles, dust and rough surfaces
/// scatter onto the focal plane, by the camera's point source transmittance. Even over the frame.
struct StrayLight {
  static constexpr EffectFacts facts{
      "stray_light", "light of Sun, Moon and Earth beside the field, scattered by the optics",
      "no background of it: 1e-6 of the Sun's light is 1e4 times the night sky's",
      "a measured point source transmittance"};
  static bool applies(const SceneFacts& scene) { return scene.stray_light; }
  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  /// Angles of a source from the boresight [deg], rising, 0..180; and the focal plane's irradiance
  /// over the aperture's there, 0..1. Empty: none.
  std::vector<double> angle_deg, transmittance;

  bool any() const { return !angle_deg.empty(); }
  /// At an angle: the logarithm is linear between rows, and the ends hold beyond them; linear next
  /// to a row of 0.
  double at(double angle_rad) const;
};

}  // namespace dmise
