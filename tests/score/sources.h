#pragma once
#include <string>

#include "core/base/units.h"
#include "core/score/score.h"

namespace dmise::test {

/// A truth with a straight, whole trail and its light in the middle.
inline TrueSource source(const std::string& id, PixelPosition start, PixelPosition end,
                         const std::string& frame = "1", const std::string& sensor = "eye") {
  const PixelPosition middle = (start + end) * 0.5;
  return {.sensor = sensor,
          .frame = frame,
          .id = id,
          .start = start,
          .middle = middle,
          .end = end,
          .light = middle,
          .signal_e = 1e5};
}

/// A detection of exactly the line between two ends; a point if they are equal.
inline FoundSource found(std::uint32_t index, PixelPosition end1, PixelPosition end2,
                         const std::string& frame = "1", const std::string& sensor = "eye") {
  const PixelPosition middle = (end1 + end2) * 0.5, line = end2 - end1;
  Detection d{.id = sensor + "/" + frame + "/" + std::to_string(index), .index = index};
  d.x_px = middle.x_px;
  d.y_px = middle.y_px;
  d.end1_x_px = end1.x_px;
  d.end1_y_px = end1.y_px;
  d.end2_x_px = end2.x_px;
  d.end2_y_px = end2.y_px;
  d.length_px = std::hypot(line.x_px, line.y_px);
  d.kind = d.length_px > 0 ? DetectionKind::streak : DetectionKind::point;
  d.covariance_px2 = {0.01, 0.0, 0.01};
  d.covariance_rad2 = {arcsec * arcsec, 0.0, arcsec * arcsec};
  d.signal_e = 1e5;
  d.magnitude_sigma = 0.1;
  return {sensor, frame, d};
}

/// 1000 x 800 px, noise 10 e-, a PSF of sigma 1 px, 2 s, 3600 arcsec/px.
inline ScoredFrame frame(const std::string& name = "1", const std::string& sensor = "eye") {
  return {.sensor = sensor,
          .frame = name,
          .columns = 1000,
          .rows = 800,
          .noise_e = 10.0,
          .sigma_px = 1.0,
          .exposure_s = 2.0,
          .scale_rad_per_px = 1.0 * deg};
}

}  // namespace dmise::test
