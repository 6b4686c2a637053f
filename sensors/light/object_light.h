#pragma once
#include <functional>
#include <vector>

#include "core/products/truth.h"
#include "sensors/light/expected_electrons.h"

namespace dmise {

/// Takes the light that one object alone leaves in a frame [e-], none in its border of reference
/// pixels, and the expected noise of the frame's pixels with all its light [e-]. The images are
/// valid during the call.
using ObjectLightTaker = std::function<void(const Truth&, const ExpectedElectronImage& light,
                                            const ElectronImage& noise)>;

/// Calls `take` with each object of `truths` that left light in the frame of `view`, in their
/// order. The sum of all lights, the stars' and the sky's is the frame's expected electrons.
/// `commanded`, `sources` and `optics` are those of the frame; the light on `optics` is lost.
void take_object_lights(const View& view, const FrameTimes& commanded, const LightSources& sources,
                        OpticsStage& optics, const std::vector<Truth>& truths,
                        const ElectronImage& noise, Threads& threads, const ObjectLightTaker& take);

}  // namespace dmise
