#pragma once
#include <vector>

#include "core/detection/scene.h"

namespace dmise {

/// SNR of a source of known shape in the noise and the scatter of the sky: the sum of pixels
/// weighted by the shape, which is the best of all statistics. What is hidden, lit by stars or
/// clipped does not count.
double template_snr(const Scene& scene, const Trail& trail);

/// The trail near `start` for which `template_snr` is largest, by steps of its
/// offset, direction and ends, and that SNR.
struct TemplateMatch {
  Trail trail;
  double snr = 0.0;
};

TemplateMatch best_template(const Scene& scene, const Trail& start);

}  // namespace dmise
