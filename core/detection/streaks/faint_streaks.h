#pragma once
#include <vector>

#include "core/base/parallel.h"
#include "core/detection/pixels/components.h"
#include "core/detection/source/beamlets.h"
#include "core/detection/source/scene.h"

namespace dmise {

/// Lengthens a streak of which only the pixels above a threshold were found, as far as its light
/// continues in `frame`, in which no sources are hidden yet.
void extend(const Scene& scene, const FilteredFrame& frame, Source& source);

/// Returns the least SNR of a trail of this length at which noise alone gives at most 0.1 of them
/// in a frame of 8.3 Mpx. More lines of greater length fit into a frame, from 40 px on also bent
/// ones.
double min_streak_snr(double length_px);

/// Returns the factor by which the least SNR of a trail is raised where more than a tenth of the
/// frame is hidden or the sky scatters more than noise: fainter stars that were not hidden give
/// sums a longer tail.
double crowding(const FilteredFrame& frame, const Trail& trail);

/// Whether a component that is no source may be the brightest part of a faint streak.
bool may_be_part_of_streak(const Component& component);

/// Finds faint streaks of which such components, which are not hidden in `frame`, are parts: light
/// along a line through one is much more than that of a star there. What it finds is hidden.
std::vector<Source> streaks_through(const Scene& scene, FilteredFrame& frame,
                                    const std::vector<const Component*>& parts);

/// Finds streaks that no threshold of single pixels shows, strongest first, from the beamlets of a
/// frame in which stars and known sources are hidden. What it finds is hidden too.
std::vector<Source> find_faint_streaks(const Scene& scene, FilteredFrame& frame, Threads& threads);

}  // namespace dmise
