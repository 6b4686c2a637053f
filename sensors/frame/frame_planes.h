#pragma once
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/config/scenario.h"
#include "core/detector/exposure/expose.h"
#include "sensors/scene/view.h"

namespace dmise {

/// Light in the band at the aperture, with the point spread of the optics in it
/// [photons/s/m2/sr].
using RadianceMap = Image<float, struct RadianceCarrier>;

/// The radiance in a part of the camera's band.
struct BandRadiance {
  Band band;
  RadianceMap map;
};

/// What the counts of a frame were drawn from. Only what the scenario asks for is filled in.
struct FramePlanes {
  ExpectedElectronImage sources, background;  // expected photo-electrons a second
  ElectronImage noise;  // expected standard deviation from frame to frame [e-]
  RadianceMap radiance;
  std::vector<BandRadiance> radiance_parts;  // in parts of the band, where they are asked for
};

/// Returns the radiance at the aperture that gives `light` [e-] in an exposure.
RadianceMap radiance_of(const View& view, double exposure_s, const ExpectedElectronImage& light,
                        Threads& threads);

/// Call when `light` [e-] holds all that falls on the detector during `exposure` and the
/// background, where it is wanted, the sky alone.
void make_planes(const OutputConfig& wanted, const View& view, const Exposure& exposure,
                 const ExpectedElectronImage& light, Threads& threads, FramePlanes& planes);

}  // namespace dmise
