#pragma once
#include "core/detector/exposure/expose.h"

namespace dmise {

/// The electrons that `expose` gives each pixel before it is digitised, without what is drawn anew
/// in each frame: photons and dark current by their means, no column and read noise. Hot pixels and
/// cosmic rays are those of the frame; traps are empty.
ElectronImage expected_signal(const ExpectedElectronImage& light, const Detector& detector,
                              const Exposure& exposure, const EffectSet& effects, Threads& threads);

}  // namespace dmise
