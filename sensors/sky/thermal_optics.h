#pragma once
#include "core/sky/sky_grid.h"
#include "sensors/scene/view.h"

namespace dmise {

/// Electrons of a pixel by the heat of telescope and window in the exposure: their radiance in the
/// band over the solid angle that the pixel sees through the pupil. 0 where it doesn't act.
PixelFunction thermal_optics_electrons(const View& view);

/// Electrons of the pixel on the optical axis.
double thermal_optics_e(const View& view);

}  // namespace dmise
