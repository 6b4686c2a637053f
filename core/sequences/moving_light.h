#pragma once
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/sequences/filtered_sequence.h"
#include "core/sequences/registration.h"

namespace dmise {

/// SNR of a point in the middle of each pixel, after subtraction of what stays on the sky; 0 where
/// it is not known.
using MovingSnr = Image<float, struct MovingSnrCarrier>;
/// SNR of a point that has 1 electron in the reference frame; 0 where it is not known.
using PointWeight = Image<float, struct PointWeightCarrier>;

/// A frame without what stays on the sky. A point of `f` electrons of amplitude has the mean SNR
/// `f * weight` at its place.
struct MovingLight {
  MovingSnr snr;
  PointWeight weight;
};

/// Subtracts from each frame the mean of the others at the same place of the sky, without the
/// values that stand out (stars, galaxies and the glow between them vanish, in a catalogue or not).
/// The noise is that of frame and mean; where stars shine it is as measured over all frames at
/// places of such starlight: it has the errors of registration, seeing and scintillation.
/// Equal for any number of threads.
std::vector<MovingLight> moving_light(const FilteredSequence& sequence,
                                      const Registration& registration, Threads& threads);

/// Cubic interpolation (Keys 1981, IEEE Trans. ASSP 29, 1153) of the values of pixels at distances
/// 1 + t, t, 1 - t, 2 - t, t in [0, 1].
std::array<float, 4> cubic_weights(double t);
/// Derivatives of the weights by t.
std::array<float, 4> cubic_slopes(double t);

}  // namespace dmise
