#pragma once
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace dmise {

/// Weighted mean and scatter of each pixel over frames, in one pass, without what a charged
/// particle left in one of them: the largest value of a pixel is left out if it is far above the
/// others.
class PixelSeries {
 public:
  explicit PixelSeries(std::size_t pixels);

  /// Adds a frame: `values` near 0 in ordinary pixels, their standard deviation `sigma`. A pixel
  /// with NaN has no value from then on.
  void add(std::span<const float> values, double sigma);

  /// A pixel over all frames.
  struct Result {
    double mean = 0.0;
    double variance = 0.0;  // scatter between frames over that by their sigmas: 1 if as expected
    bool struck = false;    // by a particle: its largest value is left out
  };
  /// Takes two frames at least. NaN where a frame has no value.
  Result at(std::size_t pixel) const;

  /// The value of a pixel in the only frame.
  double only(std::size_t pixel) const { return pixels_[pixel].sum / weight_; }

  int frames() const { return int(weights_.size()); }
  double weight() const { return weight_; }  // sum of 1 / sigma^2 over all frames

 private:
  struct Pixel {
    double sum = 0.0, squares = 0.0;  // weighted
    float largest = 0.0f;             // over its frame's sigma
    std::uint32_t frame = 0;          // that holds it
  };
  std::vector<Pixel> pixels_;
  std::vector<double> weights_;
  double weight_ = 0.0;
};

}  // namespace dmise
