#pragma once
#include <span>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/sky/sky_grid.h"
#include "core/sky/sky_model.h"
#include "sensors/scene/gl_evaluator.h"
#include "sensors/scene/view.h"

namespace dmise {

/// The sky over a sensor in its band in the middle of its exposure: the parts that are on, Sun and
/// Moon where the environment says. Stars that are `drawn` one by one are left out.
SkyModel sky_over(const View& view, const DrawnStars& drawn);

/// Expected electrons of a sky in a pixel: at its centre, times its own solid angle; 0 where the
/// Earth hides it. `view` and `sky` must outlive it.
PixelFunction electrons_of(const View& view, const SkyModel& sky);

/// Fills `image` with the expected electrons of `sky_over`. From a grid, within the tolerance of
/// `SkyGrid` at the sensor's level. All zero with the effect off. With an `evaluator` that one
/// draws the grid.
void fill_sky(const View& view, const DrawnStars& drawn, ExpectedElectronImage& image,
              Threads& threads, GlEvaluator* evaluator = nullptr);

/// Adds the heat of telescope and window to images; null ones are left.
void add_thermal_optics(const View& view, std::span<ExpectedElectronImage* const> images,
                        Threads& threads);

/// Fills `image` with what of the same sky comes from beyond every object: on the ground zodiacal
/// light and faint starlight, as the air and lamps shine before objects; in orbit all of it.
void fill_sky_behind(const View& view, const DrawnStars& drawn, ExpectedElectronImage& image,
                     Threads& threads);

}  // namespace dmise
