#pragma once
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/effects/plan_facts.h"
#include "sensors/light/star_layer.h"
#include "sensors/scene/occlusion_mask.h"
#include "sensors/scene/optics_stage.h"
#include "sensors/scene/view.h"

namespace dmise {

/// Adds to `image` the light of the planets whose discs have a radius of half a pixel or more, as
/// lit spheres, like other discs.
void draw_planet_discs(const View& view, OpticsStage& optics, ExpectedElectronImage& image,
                       Threads& threads);

/// Adds to `image` the light of the other planets that gets past `mask`, as points in the middle of
/// their light, along their trails. `truth`, if not null, gets all planets with light in the frame.
void draw_planet_points(const View& view, OpticsStage& optics, const OcclusionMask& mask,
                        ExpectedElectronImage& image, std::vector<StarTruth>* truth);

/// Adds planets in the field to the facts of a plan: as stars, and as what light time displaces.
void add_planet_facts(const View& view, PlanFacts& facts);

}  // namespace dmise
