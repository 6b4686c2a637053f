#pragma once

namespace dmise {

/// A detector's figures; every one has its place in the chain of `expose`. What is 0 does nothing.
struct Detector {
  double quantum_efficiency = 1.0;  // mean over the band, (0, 1]
  double dark_e_per_s = 0.0;
  double read_noise_e = 0.0;  // rms
  double full_well_e = 1e5;
  double gain_e_per_dn = 1.0;
  double bias_dn = 0.0;
  int adc_bits = 16;  // 1..16

  double prnu_rms = 0.0;            // pixel response non-uniformity, relative
  double hot_pixel_fraction = 0.0;  // of all pixels, 0..1
  double hot_pixel_e_per_s = 0.0;   // mean of their extra dark current, exponentially distributed
  double column_noise_e = 0.0;      // rms offset of a column, new in every frame
  double nonlinearity = 0.0;        // relative loss of signal at full well, 0..0.5
  double interpixel_coupling =
      0.0;                // share of a pixel's signal seen by each of four neighbours, 0..0.2
  bool blooming = false;  // charge above the full well runs along the column
  double persistence_fraction = 0.0;    // of the collected charge is trapped, 0..1 ...
  double persistence_s = 0.0;           // ... and freed with this time constant
  double cosmic_rays_per_px_s = 0.0;    // hits
  double cosmic_ray_e_per_px = 1000.0;  // charge left in a pixel pitch of track
  double cosmic_ray_depth_px = 1.0;     // depth of the sensitive layer in pixel pitches
  int reference_px = 0;                 // border of pixels that see neither light nor dark current

  bool operator==(const Detector&) const = default;
};

/// Throws `ConfigError` "detector.KEY: reason, got value" for figures that no detector can have.
void check(const Detector& detector);

/// Dark current that doubles every `doubling_k` kelvin, known at a reference temperature [e-/s].
double dark_current_at(double temperature_k, double reference_e_per_s, double reference_k,
                       double doubling_k);

}  // namespace dmise
