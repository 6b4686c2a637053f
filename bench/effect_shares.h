#pragma once
#include "core/sky/stars/star_catalogue.h"
#include "sensors/scene/view.h"

namespace dmise {

/// Seconds of a frame that corrections of `star_places` places (proper motion ... refraction) and
/// the parts of a sky that took `sky_s` account for. They run interleaved: each correction is
/// measured on a sample of the catalogue, with it and without it, each part on directions all over
/// the frame, and scaled.
EffectTimes effect_shares(const View& view, const StarTable& stars, std::size_t star_places,
                          double sky_s);

}  // namespace dmise
