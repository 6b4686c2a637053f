#pragma once
#include <vector>

#include "core/optics/lens_ghost.h"

namespace dmise {

/// Effects on the whole image, in the order in which they act.
using ImageEffects = EffectList<LensGhost>;

struct ImageOptics : ImageEffects::Parameters {
  bool operator==(const ImageOptics&) const = default;
};

std::span<const ImageParameter> image_parameters();

/// Without the effects that are off.
ImageOptics acting_optics(const ImageOptics& optics, const EffectSet& effects);

/// Applies those that have something to do to the light of a frame.
void apply_image_optics(const ImageOptics& acting, ExpectedElectronImage& image, Threads& threads,
                        EffectTimes& times);

}  // namespace dmise
