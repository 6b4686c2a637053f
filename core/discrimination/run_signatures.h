#pragma once
#include <string>
#include <vector>

#include "core/base/files/read_progress.h"
#include "core/base/parallel.h"
#include "core/discrimination/aperture_photometry.h"
#include "core/discrimination/spectral_signature.h"
#include "core/photometry/band.h"

namespace dmise {

/// One camera of a run, with what its frames need to become reflected light.
struct SpectralSensor {
  std::string name;
  Band band;
  double aperture_fraction = 1.0;
};

/// What a sensor measured of an object in one frame.
struct BandMeasurement {
  PixelPosition centre;  // where the aperture is
  ApertureFlux flux;
  Measured light;  // `reflected`
};

/// An object in the frames of one number, in every band.
struct SpectralSample {
  std::string object;
  std::uint32_t frame = 0;
  std::vector<BandMeasurement> bands;  // as `sensors` of the run
};

/// Light of all objects of a run that every sensor has whole in a frame of the same number.
struct RunSpectra {
  std::vector<SpectralSensor> sensors;  // by wavelength
  std::vector<SpectralSample> samples;  // by object and frame
  std::vector<std::string> left_out;    // "SENSOR/FRAME OBJECT: reason"
};

/// Measures the objects of a run's truth in its frames. `sensors`: names; empty: all. Apertures are
/// centred where the truth has the object's light. Throws `ConfigError` "FILE: reason" for what is
/// missing or invalid, for fewer than two bands, and for cameras whose point spread is not round.
RunSpectra measure_run(const std::string& directory, std::vector<std::string> sensors,
                       const Aperture& aperture, Threads& threads, const ReadProgress& progress);

/// Sums of an object's light in each band over its samples.
std::vector<Measured> summed_light(const RunSpectra& spectra, const std::string& object);

/// Names of the objects, each once, in order.
std::vector<std::string> objects_of(const RunSpectra& spectra);

}  // namespace dmise
