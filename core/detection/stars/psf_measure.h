#pragma once
#include <span>
#include <vector>

#include "core/detection/light/psf.h"
#include "core/detection/pixels/components.h"
#include "core/detection/source/scene.h"

namespace dmise {

/// Measures the PSF of a frame from its stars, as trails of the length and direction that the
/// header gives them: the width of the nearest Gaussian, its change over the frame where that is
/// significant, and the shape with its wings. Returns `scene.psf`, the header's, where fewer than 8
/// stars are bright, whole and alone. Uses one thread.
PsfField measure_psf(const Scene& scene, const std::vector<Component>& components);

/// Measures it from stars whose trails were found, each without the light of the others, also where
/// few are alone. Returns `scene.psf` where it cannot.
PsfField measure_psf_of_trails(const Scene& scene, std::span<const Trail> trails);

}  // namespace dmise
