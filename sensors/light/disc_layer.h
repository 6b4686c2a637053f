#pragma once
#include "core/base/image.h"
#include "core/base/parallel.h"
#include "sensors/scene/optics_stage.h"
#include "sensors/scene/view.h"

namespace dmise {

/// Adds to `image` the light of a disc in the field, blurred by `optics`, which has begun the
/// exposure. Sun and Moon stand where their light seems to come from, each pixel through the air
/// that it looks through; the Earth stands where its ellipsoid is. Pixels on an edge are sampled
/// many times. A disc that moves past the camera is drawn at up to 32 times of the exposure. Stars
/// and objects behind are not hidden, but the Sun by the Moon.
void draw_sun(const View& view, OpticsStage& optics, ExpectedElectronImage& image,
              Threads& threads);
void draw_moon(const View& view, OpticsStage& optics, ExpectedElectronImage& image,
               Threads& threads);
void draw_earth(const View& view, OpticsStage& optics, ExpectedElectronImage& image,
                Threads& threads);

/// Adds to the facts of a plan what discs in the field and stray light leave in pixels.
void add_disc_facts(const View& view, PlanFacts& facts);

}  // namespace dmise
