#include "core/image/charts/picture.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/numeric/quantile.h"

namespace dmise {
namespace {

constexpr int min_columns = 640;       // narrower frames have larger pixels in a picture
constexpr double black_sigma = 2.5;    // below the median, in the sky's noise
constexpr double white_sigma = 250.0;  // above it
constexpr double white_share = 0.005;  // maximum fraction of pixels above white
constexpr double linear_sigma = 4.0;   // where asinh turns from linear to logarithmic

/// Mean over `factor` x `factor` squares; remaining columns and rows are dropped.
Image<float, struct Averaged> average(const CountImage& counts, int factor) {
  Image<float, Averaged> out(std::max(1, counts.columns / factor),
                             std::max(1, counts.rows / factor));
  const int wide = std::min(factor, counts.columns), high = std::min(factor, counts.rows);
  for (int y = 0; y < out.rows; ++y)
    for (int x = 0; x < out.columns; ++x) {
      std::uint32_t sum = 0;
      for (int j = 0; j < high; ++j)
        for (int i = 0; i < wide; ++i) sum += counts.at(x * factor + i, y * factor + j);
      out.at(x, y) = float(sum) / float(wide * high);
    }
  return out;
}

struct Sky {
  float median, sigma;
};

/// Median and noise (from the median and the 16 % quantile) of at most 2^16 pixels. If more than a
/// few pixels would be white, an object fills a part of the frame: the noise is then increased
/// until all but the brightest of them are below white.
Sky sky_of(const std::vector<float>& pixels) {
  std::vector<float> sample;
  const std::size_t step = pixels.size() / 65536 + 1;
  for (std::size_t i = 0; i < pixels.size(); i += step) sample.push_back(pixels[i]);
  const float low = quantile_of(sample, 0.1587), median = quantile_of(sample, 0.5);
  const float sigma = std::max(median - low, 1e-3f * std::max(1.0f, std::abs(median)));
  const float white = median + float(white_sigma) * sigma;
  const auto beyond = std::ranges::count_if(sample, [&](float v) { return v > white; });
  if (double(beyond) <= white_share * double(sample.size())) return {median, sigma};
  const double brightest = 0.01 * double(beyond) / double(sample.size());  // 1 % of these
  return {median, float((quantile_of(sample, 1.0 - brightest) - median) / white_sigma)};
}

}  // namespace

Preview preview(const CountImage& counts, int max_columns) {
  const int shrink = std::max(1, (counts.columns + max_columns - 1) / max_columns);
  const int grow = std::max(1, min_columns / std::max(1, counts.columns));
  const auto small = average(counts, shrink);
  const Sky sky = sky_of(small.pixels);
  const double white = std::asinh((black_sigma + white_sigma) / linear_sigma);
  const auto grey = [&](float value) {
    const double v = (double(value) - sky.median) / sky.sigma + black_sigma;
    const double level = 255.0 * std::asinh(v / linear_sigma) / white;
    return std::uint8_t(std::clamp(std::lround(level), 0l, 255l));
  };
  Preview out;
  out.pixels_per_px = double(grow) / shrink;
  out.picture = {small.columns * grow, small.rows * grow, 1, {}};
  out.picture.pixels.resize(std::size_t(out.picture.columns) * std::size_t(out.picture.rows));
  auto* at = out.picture.pixels.data();
  for (int y = 0; y < out.picture.rows; ++y)
    for (int x = 0; x < out.picture.columns; ++x) *at++ = grey(small.at(x / grow, y / grow));
  return out;
}

}  // namespace dmise
