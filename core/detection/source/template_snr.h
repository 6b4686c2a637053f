#pragma once
#include "core/detection/source/scene.h"

namespace dmise {

/// The sky around a place with the stars that are too faint to be known.
struct StarlitSky {
  double level = 0.0, scatter = 1.0;  // in a pixel's noise
};

StarlitSky starlit_sky(const Scene& scene, const Trail& trail);

/// Returns the SNR of a source of known shape in the noise and the scatter of the sky: the sum of
/// pixels weighted by the shape, the most sensitive statistic. Pixels that are hidden, lit by stars
/// or clipped do not count.
double template_snr(const Scene& scene, const Trail& trail);

/// A trail and its `template_snr`.
struct TemplateMatch {
  Trail trail;
  double snr = 0.0;
};

/// The trail near `start` for which that is largest, by steps of its offset, direction and ends.
TemplateMatch best_template(const Scene& scene, const Trail& start);

}  // namespace dmise
