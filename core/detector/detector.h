#pragma once
#include <optional>
#include <string>

#include "core/effects/effects.h"

namespace dmise {

/// A detector's figures; every one has its place in the chain of `expose`. What is 0 does nothing
/// and costs nothing. Ranges, FITS keywords and effects are in core/detector/detector_figures.h.
struct Detector {
  double quantum_efficiency = 1.0;  // mean over the band, (0, 1]
  double dark_e_per_s = 0.0;        // at dark_reference_c
  double dark_reference_c = 0.0;    // [deg C]
  double temperature_c = 0.0;       // of the detector [deg C]
  double dark_doubling_k = 0.0;     // warming that doubles dark current; 0: it never changes
  double read_noise_e = 0.0;        // rms
  double full_well_e = 1e5;
  double gain_e_per_dn = 1.0;
  double bias_dn = 0.0;
  int adc_bits = 16;  // 1..16: counts are 16-bit numbers in frames and messages

  double prnu_rms = 0.0;             // pixel response non-uniformity, relative
  double hot_pixel_fraction = 0.0;   // of all pixels, 0..1
  double hot_pixel_e_per_s = 0.0;    // mean of their extra dark current, exponentially distributed,
                                     // at dark_reference_c
  double column_noise_e = 0.0;       // rms offset of a column, new in every frame
  double nonlinearity = 0.0;         // relative loss of signal at full well, 0..0.5
  double interpixel_coupling = 0.0;  // share of a pixel's signal seen by each of four neighbours
  bool blooming = false;             // charge above the full well runs along the column
  double persistence_fraction = 0.0;    // of the charge collected is trapped, 0..1 ...
  double persistence_s = 0.0;           // ... and freed with this time constant
  double cosmic_rays_per_px_s = 0.0;    // hits
  double cosmic_ray_e_per_px = 1000.0;  // charge left in a pixel pitch of track
  double cosmic_ray_depth_px = 1.0;     // depth of the sensitive layer in pixel pitches
  int reference_px = 0;                 // border of pixels that see neither light nor dark current

  bool operator==(const Detector&) const = default;
};

/// A figure that no detector can have.
struct DetectorFault {
  std::string key, reason;  // the field's name; "must be ..."
  double got = 0.0;
};
/// The first fault, if any.
std::optional<DetectorFault> fault_of(const Detector& detector);
/// Throws `ConfigError` "detector.KEY: reason, got value" when there is one.
void check(const Detector& detector);

/// Dark current that doubles every `doubling_k` kelvin, known at a reference temperature [e-/s].
/// Temperatures on any one scale of kelvins.
double dark_current_at(double temperature_k, double reference_e_per_s, double reference_k,
                       double doubling_k);
/// By how much the detector's temperature multiplies the dark current of its reference.
double thermal_factor(const Detector& detector);
/// Of an ordinary pixel, at the detector's temperature.
double dark_rate_e_per_s(const Detector& detector);

/// False when an effect of the detector's can't act, for its figure is 0; true for all others.
bool has_figure(const Detector& detector, Effect effect);

/// The figures as they act on a frame: those of effects that are off are 0 (quantisation: 1 e-/DN,
/// no bias, 16 bits); dark currents and their reference are those at `temperature_c`.
Detector in_effect(const Detector& detector, const EffectSet& effects);

}  // namespace dmise
