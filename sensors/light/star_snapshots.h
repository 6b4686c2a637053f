#pragma once
#include <span>
#include <vector>

#include "core/base/image.h"
#include "core/sky/places/apparent.h"
#include "sensors/scene/occlusion_mask.h"
#include "sensors/scene/optics_stage.h"
#include "sensors/scene/spectra.h"
#include "sensors/scene/view.h"
#include "sensors/sky/star_exposure.h"

namespace dmise {

/// Time-delay integration of stars: `count` snapshots in the middles of equal parts of the
/// exposure, in each of which every star is placed anew, as a point with its share of the light.
/// `stars`: by their places in `columns`, or astrometric ones; `signal_e`: of each over the
/// exposure, vignetting aside. `spectra`: null for points without dispersion. Returns what of each
/// fell inside.
std::vector<Deposited> draw_star_snapshots(const View& view, const StarColumns& columns,
                                           std::span<const StarTrail> stars,
                                           std::span<const double> signal_e, int count,
                                           const Spectra* spectra, OpticsStage& optics,
                                           const OcclusionMask& mask, ExpectedElectronImage& image);

}  // namespace dmise
