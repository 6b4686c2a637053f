#pragma once
#include <array>
#include <string_view>

#include "core/base/numeric/monotone_cubic.h"
#include "core/base/pixel.h"
#include "core/effects/effects.h"
#include "core/optics/field_radius.h"

namespace dmise {

struct Optics;

/// Light lost off the axis, besides what the projection does to a pixel's solid angle.
struct Vignetting {
  static constexpr EffectFacts facts{
      "vignetting", "lenses lose light off the axis",
      "corners too bright: 0.16 mag at 30 deg by the pupil alone",
      "cos theta of the pupil and a power of the distance from the axis, or a measured table"};
  static bool applies(const SceneFacts& scene) { return scene.vignettes; }

  static ErrorBound error(int, const PlanFacts& f);
  static double cost_s(int level, const PlanFacts& f);

  /// The entrance pupil is seen foreshortened: cos theta. With a gnomonic lens, whose pixels' solid
  /// angle goes as cos^3 theta, the sky falls off as cos^4 theta.
  bool natural = false;
  /// Transmission in the farthest corner relative to the centre, (0, 1], of stops and lens rims; it
  /// falls as the `power` of the distance from the principal point.
  double corner = 1.0;
  double power = 2.0;  // 1..16

  /// Relative illumination, 0..1, by the distance from the axis, in place of all that: a measured
  /// lens. Beyond its ends it keeps its end values; where no direction is imaged it is 0.
  MonotoneCubic table;
  FieldRadius table_radius = FieldRadius::angle_deg;

  bool any() const { return natural || corner < 1.0 || !table.empty(); }
  bool operator==(const Vignetting&) const = default;
};

/// Light that reaches a pixel, relative to the boresight's: 0..1; anywhere in the image plane.
double relative_illumination(const Optics& optics, PixelPosition pixel);

/// Steepest change of the table's illumination within the frame, relative to it [1/px]; 0 without a
/// table.
double illumination_slope_per_px(const Optics& optics);

}  // namespace dmise
