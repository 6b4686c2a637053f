#pragma once
#include "core/base/image.h"
#include "core/base/parallel.h"
#include "sensors/scene/optics_stage.h"
#include "sensors/scene/view.h"

// The air over the Earth's limb, in the frames of a sensor in space.
namespace dmise {

/// Whether a line of sight in the field, or within `disc_margin_px` of it, comes through air that
/// shines.
bool limb_is_seen(const View& view, SimTime t);

/// Adds its light to `image`, blurred by `optics`, which has begun the exposure. A pixel across
/// which the height of lines of sight over the ground differs by more than 1 km is sampled at 8
/// places or more, each row at its own time; where the camera or the Earth moves, at up to 8 times
/// of the exposure.
void draw_limb_airglow(const View& view, OpticsStage& optics, ExpectedElectronImage& image,
                       Threads& threads);
void draw_limb_air(const View& view, OpticsStage& optics, ExpectedElectronImage& image,
                   Threads& threads);

/// Adds to the facts of a plan what they leave in pixels.
void add_limb_facts(const View& view, PlanFacts& facts);

}  // namespace dmise
