#include "core/report/embedded_image.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/base/numeric/quantile.h"
#include "core/report/compact_bytes.h"

namespace dmise {
namespace {

constexpr double steps_of_noise = 3.0;

std::vector<float> means(const CountImage& counts, int bin, int columns, int rows) {
  std::vector<float> out(std::size_t(columns) * std::size_t(rows));
  std::vector<std::uint32_t> sums(static_cast<std::size_t>(columns));
  for (int y = 0; y < rows; ++y) {
    const int begin = y * bin, end = std::min(begin + bin, counts.rows);
    std::fill(sums.begin(), sums.end(), 0u);
    for (int j = begin; j < end; ++j) {
      const std::uint16_t* row = counts.row(j);
      const int whole = counts.columns / bin;
      for (int x = 0; x < whole; ++x) {
        std::uint32_t sum = 0;
        for (int i = 0; i < bin; ++i) sum += row[x * bin + i];
        sums[std::size_t(x)] += sum;
      }
      for (int i = whole * bin; i < counts.columns; ++i) sums[std::size_t(whole)] += row[i];
    }
    for (int x = 0; x < columns; ++x) {
      const int wide = std::min(bin, counts.columns - x * bin);
      out[std::size_t(y) * std::size_t(columns) + std::size_t(x)] =
          float(sums[std::size_t(x)]) / float(wide * (end - begin));
    }
  }
  return out;
}

/// Standard deviation of the noise, by the median difference of neighbours [DN].
double noise_of(const std::vector<float>& pixels) {
  std::vector<float> differences;
  const std::size_t step = pixels.size() / 65536 + 1;
  for (std::size_t i = 0; i + 1 < pixels.size(); i += step)
    differences.push_back(std::abs(pixels[i + 1] - pixels[i]));
  if (differences.empty()) return 0.0;
  return double(middle_of(std::move(differences))) * sigma_of_median / std::sqrt(2.0);
}

}  // namespace

EmbeddedImage embed(const CountImage& counts, std::size_t max_pixels) {
  EmbeddedImage out;
  const auto size = [&](int pixels) { return std::max(1, (pixels + out.bin - 1) / out.bin); };
  while (std::size_t(size(counts.columns)) * std::size_t(size(counts.rows)) > max_pixels) ++out.bin;
  out.columns = size(counts.columns);
  out.rows = size(counts.rows);
  const std::vector<float> pixels = means(counts, out.bin, out.columns, out.rows);
  const auto [least, most] = std::minmax_element(pixels.begin(), pixels.end());
  const double exact = 1.0 / (double(out.bin) * out.bin);  // means are its multiples
  out.min_dn = double(*least);
  out.step_dn = std::max(
      {exact, noise_of(pixels) / steps_of_noise, (double(*most) - double(*least)) / 65535.0});
  // As differences from the left, and of the first column from above, which deflate better.
  std::vector<std::uint16_t> differences(pixels.size());
  std::uint16_t above = 0;
  for (std::size_t i = 0; i < pixels.size();) {
    std::uint16_t left = above;
    for (int x = 0; x < out.columns; ++x, ++i) {
      const auto number =
          std::uint16_t(std::lround((double(pixels[i]) - out.min_dn) / out.step_dn));
      differences[i] = std::uint16_t(number - left);
      left = number;
      if (x == 0) above = number;
    }
  }
  out.pixels = compact(byte_planes(differences));
  return out;
}

}  // namespace dmise
