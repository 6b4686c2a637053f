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
  double mean = 0.0, scatter = 0.0;  // of the ratio
  double theory = 0.0;               // its standard deviation by the expected noise of every pixel
  double z_width = 0.0;              // standard deviation of (ratio - truth) over its stated error
  double snr_r = 0.0;                // mean flux over its scatter in the shorter band

  /// |mean - truth| in standard errors of the mean.
  double bias_sigma() const;
};

/// Exposes a window about both objects of `launch/scenarios/paper/space-imager.yaml` with the
/// seeds from 1 on, and measures it (core/discrimination).
std::vector<SeedStudy> study_seeds(std::size_t seeds, const Aperture& aperture, Threads& threads);

/// Wall-clock seconds of the whole sequence of that scenario, 2 x 20 frames of 4096 x 4096, from
/// the scenario to FITS files: each camera in a thread of its own.
double sequence_seconds();

}  // namespace dmise
