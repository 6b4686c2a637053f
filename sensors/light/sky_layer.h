#pragma once
#include <span>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "sensors/scene/gl_evaluator.h"
#include "sensors/scene/view.h"
#include "sensors/sky/sky_light.h"

namespace dmise {

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
