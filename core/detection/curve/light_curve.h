#pragma once
#include <optional>

#include "core/detection/source/scene.h"
#include "core/products/light_curve.h"

namespace dmise {

/// Light along a streak, before it is known when the object was where: bins count from the trail's
/// first end, and the period is in pixels.
struct MeasuredCurve {
  LightCurve curve;
  // How far the line of periodic light may go on beyond either end, where the object is dark.
  double dark_first_px = 0.0, dark_last_px = 0.0;
};

/// Empty for a point, and for a streak shorter than four FWHM. A streak of
/// periodic light gets the light of all its pieces, and ends that the fit of even light has put
/// where it is dim are moved to where it ends.
std::optional<MeasuredCurve> light_curve_of(const Scene& scene, Source& source);

/// The other way round.
LightCurve reversed(LightCurve curve, double length_px);

}  // namespace dmise
