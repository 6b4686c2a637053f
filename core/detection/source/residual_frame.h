#pragma once
#include <vector>

#include "core/base/image.h"
#include "core/detection/source/point_snr.h"
#include "core/detection/source/scene.h"

namespace dmise {

/// A frame less the light of stars that were found in it.
class ResidualFrame {
 public:
  static constexpr double light_error = 0.05;  // relative, of a star's light in a pixel

  /// `snr`: the frame's, of which the stars are subtracted too; empty: it is not needed.
  explicit ResidualFrame(const Scene& scene, PointSnrImage snr = {});

  void subtract(const Trail& star) { add(star, 1.0); }
  void restore(const Trail& star) { add(star, -1.0); }

  const PointSnrImage& snr() const { return snr_; }
  void drop_snr() { snr_ = {}; }

  /// Light of the stars in a pixel.
  float light_e(int x, int y) const { return light_.at(x, y); }
  /// Variance that so much light adds: its photons and its error.
  static float variance_e2(float light_e) {
    return light_e + float(light_error * light_error) * light_e * light_e;
  }
  /// Usable pixels on a trail, less the stars, with the variance of their light.
  std::vector<FitPixel> pixels_around(const Trail& trail, double margin_px) const;

 private:
  void add(const Trail& star, double times);
  std::vector<FitPixel> pixels_with_light(const Trail& star) const;

  const Scene& scene_;
  double filtered_noise_;  // in units of a pixel's noise
  ExpectedElectronImage light_;
  PointSnrImage snr_;
};

}  // namespace dmise
