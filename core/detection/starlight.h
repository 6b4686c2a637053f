#pragma once
#include <vector>

#include "core/detection/scene.h"

namespace dmise {

/// The light of stars that were found in a frame, and what the frame has without it.
class Starlight {
 public:
  explicit Starlight(const Scene& scene);

  /// Adds `times` the light of a star: -1 takes it back.
  void add(const Trail& star, double times);
  /// The same without the filtered frame, which is not right afterwards.
  void add_electrons(const Trail& star, double times);

  double electrons(int x, int y) const { return double(electrons_[index(x, y)]); }
  /// SNR of a point at a pixel, in the frame through the matched filter of points less the stars.
  float snr(int x, int y) const { return snr_[index(x, y)]; }
  const float* snr_from(int x, int y) const { return &snr_[index(x, y)]; }  // on along its row

  /// Usable pixels on a trail less the stars, with their photons' noise and the error of their
  /// light.
  std::vector<FitPixel> pixels_less_stars(const Trail& trail, double margin_px) const;

  double filter_px() const { return filter_px_; }  // sigma of the filter
  double unit() const { return unit_; }            // noise of the filtered frame in a pixel's
  double sigma_at(const Trail& t) const { return scene_.psf.sigma_at({t.x_px, t.y_px}); }
  Psf gaussian_at(const Trail& t) const { return sigma_at(t); }

 private:
  std::size_t index(int x, int y) const {
    return std::size_t(y) * std::size_t(scene_.counts.columns) + std::size_t(x);
  }
  void filter();
  std::vector<FitPixel> reached_by(const Trail& star) const;

  const Scene& scene_;
  double filter_px_, unit_;
  std::vector<float> electrons_, snr_;
};

}  // namespace dmise
