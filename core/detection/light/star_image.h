#pragma once
#include <vector>

#include "core/detection/light/star_kernels.h"
#include "core/detection/light/trail_fit.h"

namespace dmise {

/// Light of a star around its place: a row of round Gaussians along its trail, in a box.
class StarImage {
 public:
  StarImage(int columns, int rows) : columns_(columns), rows_(rows) {}

  int x0 = 0, y0 = 0, x1 = -1, y1 = -1;  // the box in the frame, the last pixels included

  /// Fills the box with a star of a total of `flux` down to `least` a pixel.
  void draw(const Trail& trail, double sigma_px, double flux, double least) {
    draw(trail, sigma_px, flux, least, false);
  }
  /// Also its derivatives by the star's place.
  void draw_with_slopes(const Trail& trail, double sigma_px, double flux, double least) {
    draw(trail, sigma_px, flux, least, true);
  }

  /// The box's part of a row of the frame; rows follow each other by `stride`, zero beyond the box.
  const float* row(int y) const { return light_.data() + offset(y); }
  const float* row_by_x(int y) const { return by_x_.data() + offset(y); }
  const float* row_by_y(int y) const { return by_y_.data() + offset(y); }
  std::size_t width() const { return std::size_t(x1 - x0 + 1); }
  std::size_t height() const { return std::size_t(y1 - y0 + 1); }
  std::size_t stride() const { return stride_; }

 private:
  void draw(const Trail& trail, double sigma_px, double flux, double least, bool with_slopes);
  std::size_t offset(int y) const { return std::size_t(y - y0) * stride_; }

  int columns_, rows_;
  std::size_t stride_ = 0;
  std::vector<StarPoint> points_;
  std::vector<float> light_, by_x_, by_y_, scratch_;
};

}  // namespace dmise
