#pragma once
#include <vector>

#include "core/detection/detect.h"
#include "core/detection/scene.h"

namespace dmise {

// What else could have made the light: the questions that a streak must answer before it is
// believed.

/// Deviance of the pixels when `count` stars in a row along the line are fitted to them.
double deviance_of_stars(const std::vector<FitPixel>& pixels, const Trail& line, const Trail& star,
                         int count, const FitSettings& settings);

/// Is it as long as a star's trail there and along it? At the frame's edge, which may have cut it:
/// no longer, and along it.
bool moves_like_star(const Source& source, const Trail& star, double tolerance_px);

/// Is a point a better account of the light around the source than a star's trail, also where only
/// the trail's ends would be?
bool point_beats_star(const Scene& scene, const Source& source, const DetectorSettings& settings);

/// Is a line a better account of the light around the source than two, three or four stars in a
/// row, and than one star whose trail it is a piece of?
bool beats_stars(const Scene& scene, const Source& source, const DetectorSettings& settings);

}  // namespace dmise
