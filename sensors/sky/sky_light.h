#pragma once
#include "core/sky/faint_starlight.h"
#include "core/sky/sky_grid.h"
#include "core/sky/sky_model.h"
#include "sensors/scene/view.h"

namespace dmise {

/// The parts of a sensor's sky that are on. Stars that are `drawn` one by one are left out.
SkyParts sky_parts_over(const View& view, const DrawnStars& drawn);

/// The sky of these parts in the sensor's band in the middle of its exposure, Sun and Moon where
/// the environment says.
SkyModel sky_of(const View& view, const SkyParts& parts);

/// `sky_of` the `sky_parts_over` a sensor.
SkyModel sky_over(const View& view, const DrawnStars& drawn);

/// Expected electrons of a sky in a pixel: at its centre, times its own solid angle; 0 where the
/// Earth hides it. `view` and `sky` must outlive it.
PixelFunction electrons_of(const View& view, const SkyModel& sky);

}  // namespace dmise
