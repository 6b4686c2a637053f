#pragma once
#include <optional>
#include <span>
#include <vector>

#include "core/detector/blooming.h"
#include "core/detector/column_noise.h"
#include "core/detector/cosmic_rays.h"
#include "core/detector/dark_current.h"
#include "core/detector/frame_transfer.h"
#include "core/detector/full_well.h"
#include "core/detector/hot_pixels.h"
#include "core/detector/interpixel_coupling.h"
#include "core/detector/nonlinearity.h"
#include "core/detector/persistence.h"
#include "core/detector/photon_noise.h"
#include "core/detector/pixel_response.h"
#include "core/detector/quantisation.h"
#include "core/detector/read_noise.h"
#include "core/detector/reference_pixels.h"

namespace dmise {

/// What happens between the light on the pixels and the counts, in the order in which it happens.
using DetectorEffects =
    EffectList<FrameTransfer, PixelResponse, PhotonNoise, DarkCurrent, HotPixels, CosmicRays,
               ReferencePixels, Persistence, FullWell, Blooming, InterpixelCoupling, Nonlinearity,
               ColumnNoise, ReadNoise, Quantisation>;

/// A detector's parameters, those of its effects first. What is 0 does nothing and costs nothing.
struct Detector : DetectorEffects::Parameters {
  double quantum_efficiency = 1.0;  // mean over the band, (0, 1]

  bool operator==(const Detector&) const = default;
};

/// Those that every header and digest has, in the order that products keep; then the others, which
/// stand there when they are not at their defaults.
std::span<const DetectorParameter> detector_parameters();
bool in_every_header(const DetectorParameter& parameter);

/// The first fault, if any.
std::optional<DetectorFault> fault_of(const Detector& detector);
/// Throws `ConfigError` "detector.KEY: reason, got value" when there is one.
void check(const Detector& detector);

/// The detector as it acts on a frame: effects that are off have parameters with which they do
/// nothing; dark currents and their reference are those at `temperature_c`.
Detector acting_detector(const Detector& detector, const EffectSet& effects);

/// The effects that have something to do in a frame of a detector as it acts, in their order.
std::vector<const EffectFacts*> applying_effects(const Detector& acting);

}  // namespace dmise
