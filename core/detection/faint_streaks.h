#pragma once
#include <vector>

#include "core/base/parallel.h"
#include "core/detection/beamlets.h"
#include "core/detection/detect.h"
#include "core/detection/scene.h"

namespace dmise {

/// Lengthens a streak of which only the pixels above a threshold were found, where its light goes
/// on in a frame in which nothing is hidden yet.
void extend(const Scene& scene, const FilteredFrame& frame, Source& source);

/// Least SNR of the best trail of a length, so that noise alone gives at most 0.1 of them in a
/// frame of 8.3 Mpx: longer lines can be laid through it in more ways, and from 40 px on be bent.
double least_streak_snr(double length_px);

/// Factor of the least SNR of a trail where more than a tenth of the frame is hidden, or the sky
/// scatters more than noise: between so many stars are others that were not hidden, and their sums
/// have a longer tail.
double crowding(const FilteredFrame& frame, const Trail& trail);

/// Finds streaks that no threshold of single pixels shows, strongest first, from the beamlets of a
/// frame in which stars and known sources are hidden. What it finds is hidden too.
std::vector<Source> find_faint_streaks(const Scene& scene, FilteredFrame& frame,
                                       const DetectorSettings& settings, Threads& threads);

}  // namespace dmise
