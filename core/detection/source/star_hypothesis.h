#pragma once
#include <vector>

#include "core/detection/source/scene.h"

namespace dmise {

// Tests of alternative explanations by stars that a streak must pass.

/// Convergence of fits that are compared: small against every margin.
inline constexpr double comparison_settled_chi2 = 0.05;

/// How much of stars' trails lies on a line that they cross: 1 if they run along it, otherwise the
/// square of the share on it; 0 where stars don't trail.
double share_of_trails_on(const Scene& scene, const Trail& line);

/// Whether a streak is so short that it may be a row of stars, which is `row_px` long without their
/// trails, or more where the PSF is wide. Trails may follow each other along a streak that has
/// their direction.
bool may_be_row_of_stars(const Scene& scene, const Trail& streak, double row_px);

/// Whether a frame has too few stars for a row of so many as make an even light of a streak's
/// length, each above the noise.
bool is_beyond_stars(const Scene& scene, const Source& streak);

/// Deviance of the pixels for a fit of `count` stars in a row along the line.
double deviance_of_stars(const std::vector<FitPixel>& pixels, const Trail& line, const Trail& star,
                         int count, const FitSettings& settings);

/// Whether a source that a catalogue would not know has the length and direction of a star's trail;
/// at the frame's edge, which may have cut it: at most the length, and the direction.
bool moves_like_star(const Scene& scene, const Source& source, const Trail& star,
                     double tolerance_px);

/// Whether a point explains the light around the source better than a star's trail, also than a
/// trail with only an end there.
bool point_beats_star(const Scene& scene, const Source& source);

/// Whether a point is what is left of two stars whose trails overlap, of which one was subtracted.
bool is_of_overlapping_trails(const Scene& scene, const Source& point);

/// Whether a line explains the light around the source better than two to four stars in a row, and
/// than a piece of one star's trail; true also if a catalogue would have these stars.
bool beats_stars(const Scene& scene, const Source& source);

/// Whether a much wider line explains the light better, as of a galaxy seen from its side.
bool is_wide_body(const Scene& scene, const Source& source);

}  // namespace dmise
