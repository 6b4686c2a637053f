#pragma once
#include <vector>

#include "core/detection/source/scene.h"

namespace dmise {

/// Finds two streaks beside each other that were taken for one, at least the FWHM apart and
/// alongside for half of the shorter's length. They are fitted together, with the covariance of
/// both, and must explain the pixels better than one bent and uneven streak. Empty if they do not.
std::vector<Source> streaks_beside(const Scene& scene, const Trail& one);

}  // namespace dmise
