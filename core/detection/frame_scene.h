#pragma once
#include "core/base/parallel.h"
#include "core/detection/source/scene.h"
#include "core/products/frame_header.h"

namespace dmise {

/// A frame as its header describes it, prepared for fits; with a Gaussian PSF of the header's
/// width. All but the header must outlive it. `unusable`: null if all pixels have a value.
Scene frame_scene(const CountImage& counts, const Background& background, const StarMotion& stars,
                  const FrameHeader& header, const PixelMask* unusable = nullptr);

/// Takes the PSF that the stars of a scene have.
void use_psf_of_stars(Scene& scene, Threads& threads);

}  // namespace dmise
