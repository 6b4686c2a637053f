#pragma once
#include <cstdint>
#include <span>
#include <vector>

#include "core/base/image.h"
#include "core/sky/apparent.h"
#include "sensors/pipeline/occlusion_mask.h"
#include "sensors/pipeline/optics_stage.h"
#include "sensors/pipeline/spectra.h"
#include "sensors/pipeline/view.h"

namespace dmise {

/// Time-delay integration of stars: `count` snapshots in the middles of equal parts of the
/// exposure, in each of which every star is placed anew, as a point with its share of the light.
/// `signal_e`: of each of `stars` (numbers in `columns`) over the exposure, vignetting aside.
/// `spectra`: null for points without dispersion; `bv`: by the numbers in `columns`. Returns what
/// of each fell inside.
std::vector<Deposited> draw_star_snapshots(const View& view, const StarColumns& columns,
                                           const std::vector<std::uint32_t>& stars,
                                           std::span<const double> signal_e, int count,
                                           const Spectra* spectra, std::span<const float> bv,
                                           OpticsStage& optics, const OcclusionMask& mask,
                                           ExpectedElectronImage& image);

}  // namespace dmise
