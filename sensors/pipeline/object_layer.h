#pragma once
#include <vector>

#include "core/base/image.h"
#include "core/base/parallel.h"
#include "core/detection/truth.h"
#include "core/optics/psf_table.h"
#include "sensors/pipeline/view.h"

namespace dmise {

/// What the light of a source at 1 photon/s/m2 in the band becomes at the detector.
struct Throughput {
  double electrons_per_photon_m2 = 0.0;  // collecting area x transmission x quantum efficiency [m2]
};
Throughput throughput(const Camera& camera);

/// Space objects as streaks: those that the field, the horizon, the Earth and its shadow leave, each
/// along its own path with its own brightness over the exposure.
class ObjectLayer {
 public:
  /// Objects whose path over the exposure may touch the frame: their directions at its start, middle
  /// and end, and the arcs between, against the field of view; the horizon (ground).
  std::vector<std::size_t> visible(const View& view) const;

  /// Adds their light to `image` and tells what was drawn. An object that is nowhere near the frame
  /// or wholly dark has no entry.
  std::vector<Truth> draw(const View& view, const std::vector<std::size_t>& objects,
                          const PsfTable& psf, RateImage& image, Threads& threads) const;
};

}  // namespace dmise
