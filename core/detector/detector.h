#pragma once
#include <optional>
#include <span>
#include <vector>

#include "core/detector/blooming.h"
#include "core/detector/brighter_fatter.h"
#include "core/detector/charge_transfer.h"
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
#include "core/detector/ramp.h"
#include "core/detector/readout/column_noise.h"
#include "core/detector/readout/em_gain.h"
#include "core/detector/readout/fixed_pattern.h"
#include "core/detector/readout/quantisation.h"
#include "core/detector/readout/read_noise.h"
#include "core/detector/reference_pixels.h"
#include "core/detector/rolling_shutter.h"

namespace dmise {

/// Effects between light on the pixels and counts, in running order.
using DetectorEffects =
    EffectList<RollingShutter, FrameTransfer, PixelResponse, PhotonNoise, BrighterFatter,
               DarkCurrent, HotPixels, CosmicRays, ReferencePixels, Persistence, FullWell, Blooming,
               ChargeTransfer, EmGain, Nonlinearity, InterpixelCoupling, Ramp, ColumnNoise,
               ReadNoise, FixedPattern, Quantisation>;

/// Parameters of a detector, those of its effects first. Effects with neutral parameters do nothing
/// and cost nothing.
struct Detector : DetectorEffects::Parameters {
  double quantum_efficiency = 1.0;  // mean over the band, (0, 1]

  bool operator==(const Detector&) const = default;
};

/// All parameters in the order of products: those in every header and digest, then the others,
/// which are included if they are not at their defaults.
std::span<const DetectorParameter> detector_parameters();
bool in_every_header(const DetectorParameter& parameter);

/// Returns the first invalid parameter, if any.
std::optional<DetectorFault> fault_of(const Detector& detector);
/// Throws `ConfigError` "detector.KEY: reason, got value" if a parameter is invalid.
void check(const Detector& detector);

/// Returns the detector for a frame: the parameters of effects that are off are neutral; dark
/// currents and their reference are those at `temperature_c`, read noise is that of a ramp's fit.
Detector acting_detector(const Detector& detector, const EffectSet& effects);

/// Whether effects that take charge, or that of neighbours, come between the draw of photons and
/// that of read noise.
bool reads_after_others(const Detector& acting);

/// The acting detector with dark current and read noise drawn together with the photons, at the
/// level of photon noise that draws Gaussian deviates; without read noise if the detector
/// `reads_after_others`.
Detector drawn_together(const Detector& acting, const EffectSet& effects);

}  // namespace dmise
