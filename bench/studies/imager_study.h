#pragma once
#include <string>
#include <vector>

#include "core/base/parallel.h"
#include "core/discrimination/aperture_photometry.h"

namespace dmise {

/// What many seeds of the paper's space imager measure of one object.
struct SeedStudy {
  std::string object, material;
  double truth = 0.0;  // ratio of the material's reflectances
  std::size_t seeds = 0;
  double mean = 0.0, scatter = 0.0;  // ratio as measured
  double without_noise = 0.0;        // the ratio of the expected light of both bands
  double theory = 0.0;               // its standard deviation by the expected noise of every pixel
  double z_width = 0.0;              // standard deviation of (ratio - truth) over its stated error
  double snr_r = 0.0;                // mean flux over its scatter in the shorter band

  /// |mean - truth| in standard errors of the mean.
  double bias_sigma() const;
};

/// What is exposed of the frame for each seed.
enum class Exposed {
  window,  // 256 x 768 pixels about both objects
  pieces,  // 48 x 48 pixels about each object: the same chain, 40 times as fast
};

/// Exposes pixels of `launch/scenarios/paper/space-imager.yaml` with the seeds from 1 on, and
/// measures both objects (core/discrimination).
std::vector<SeedStudy> study_seeds(std::size_t seeds, const Aperture& aperture, Exposed exposed,
                                   Threads& threads);

/// Wall-clock seconds of the whole sequence of that scenario, 2 x 20 frames of 4096 x 4096, from
/// the scenario to FITS files: each camera in a thread of its own.
double sequence_seconds();

}  // namespace dmise
