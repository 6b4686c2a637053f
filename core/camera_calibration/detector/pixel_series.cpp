#include "core/camera_calibration/detector/pixel_series.h"

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

constexpr double min_strike_sigmas = 8.0;

}  // namespace

PixelSeries::PixelSeries(std::size_t pixels) : pixels_(pixels) {}

void PixelSeries::add(std::span<const float> values, double sigma) {
  const double weight = 1 / (sigma * sigma);
  const auto frame = std::uint32_t(weights_.size());
  for (std::size_t i = 0; i < pixels_.size(); ++i) {
    Pixel& p = pixels_[i];
    const double v = double(values[i]);
    const auto scaled = float(v / sigma);
    p.sum += weight * v;
    p.squares += weight * v * v;
    if (frame == 0 || scaled > p.largest) {
      p.largest = scaled;
      p.frame = frame;
    }
  }
  weights_.push_back(weight);
  weight_ += weight;
}

PixelSeries::Result PixelSeries::at(std::size_t pixel) const {
  const Pixel& p = pixels_[pixel];
  const double n = double(weights_.size()), mean = p.sum / weight_;
  const double w = weights_[p.frame], largest = double(p.largest) / std::sqrt(w);
  const double others = weight_ - w, mean_of_others = (p.sum - w * largest) / others;
  const double rest =
      std::max(0.0, p.squares - w * largest * largest - others * mean_of_others * mean_of_others);
  const double scatter = n > 2 ? rest / (n - 2) : 1.0;
  const double above = (largest - mean_of_others) * std::sqrt(w);
  if (above > min_strike_sigmas * std::sqrt(std::max(1.0, scatter)))
    return {mean_of_others, scatter, true};
  return {mean, std::max(0.0, p.squares - weight_ * mean * mean) / (n - 1), false};
}

}  // namespace dmise
