#pragma once
#include <cstdint>
#include <vector>

#include "core/astrometry/star_sources.h"
#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/detection/light/psf.h"
#include "core/detection/pixels/background.h"
#include "core/sequences/sequence_frame.h"

namespace dmise {

/// Amplitude of a point in the middle of each pixel, through the matched filter, in electrons of
/// noise of one pixel: over the noise of the sky in a pixel it is the point's SNR, if all pixels
/// have a value. NaN: not known.
using PointAmplitude = Image<float, struct PointAmplitudeCarrier>;

/// Share of a point's weight, the square of its SNR, that the pixels with a value have: 255 for
/// all.
using KnownShare = Image<std::uint8_t, struct KnownShareCarrier>;

/// A frame of a sequence through the matched filter of points.
struct FilteredLight {
  double time_s = 0.0;  // middle of the exposure, after that of the reference frame
  Background background;
  double gain_e_per_dn = 1.0;
  PsfField psf;
  std::vector<PlateSource> stars;  // by falling light
  PointAmplitude light;            // by the pixels with a value
  KnownShare known;

  /// Noise of the sky in the pixels [begin, end) of a row [e-].
  void noise_row(int y, int begin, int end, float* noise_e) const {
    background.sigma_row(y, begin, end, noise_e);
    for (int x = 0; x < end - begin; ++x) noise_e[x] *= float(gain_e_per_dn);
  }
};

struct FilteredSequence {
  int columns = 0, rows = 0;
  std::size_t reference = 0;  // the frame in the middle
  double sigma_px = 1.0;      // width of the filter, one for all frames
  double exposure_s = 1.0;
  std::vector<FilteredLight> frames;

  double span_s() const { return frames.back().time_s - frames.front().time_s; }
};

/// Filters frames in the order of their times. Pixels that stay sharper than light can be, and
/// those that are clipped, are not used. Equal for any number of threads.
FilteredSequence filter_sequence(const std::vector<SequenceFrame>& frames, Threads& threads);

}  // namespace dmise
