#include "core/ingest/colour_mosaic.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/quantile.h"
#include "core/detection/pixels/background.h"

namespace dmise {
namespace {

constexpr int kind_mesh_px = 32;      // pixels of one kind, which is every second one
constexpr double min_response = 0.2;  // fainter ones would be noise alone

}  // namespace

ColourMosaic::ColourMosaic(std::span<const double> values, int columns, Threads& threads)
    : values_(values),
      columns_(columns),
      rows_(int(values.size() / std::size_t(columns))),
      map_(choose_count_map(values, columns)) {
  std::array<double, 4> noise{};
  for (std::size_t kind = 0; kind < 4; ++kind) {
    const int x0 = int(kind % 2), y0 = int(kind / 2);
    const int wide = (columns_ + 1 - x0) / 2, high = (rows_ + 1 - y0) / 2;
    std::vector<double> own;
    for (int y = y0; y < rows_; y += 2)
      for (int x = x0; x < columns_; x += 2)
        own.push_back(values[std::size_t(y) * std::size_t(columns_) + std::size_t(x)]);
    PixelMask unusable;
    kinds_[kind] = to_counts(own, wide, map_, unusable);
    const Background sky(kinds_[kind], kind_mesh_px, threads);
    sky_[kind].resize(own.size());
    for (int y = 0; y < high; ++y) {
      float* row = sky_[kind].data() + std::size_t(y) * std::size_t(wide);
      sky.level_row(y, 0, wide, row);
      for (int x = 0; x < wide; ++x) row[x] = float(map_.zero + map_.step * double(row[x]));
    }
    median_[kind] = map_.zero + map_.step * double(sky.median_level_dn());
    noise[kind] = map_.step * double(sky.median_sigma_dn());
  }
  measure_responses(noise);
}

std::array<float, 4> ColourMosaic::levels_around(int column, int row) const {
  std::array<float, 4> out{};
  for (std::size_t kind = 0; kind < 4; ++kind) {
    const int wide = (columns_ + 1 - int(kind % 2)) / 2, high = (rows_ + 1 - int(kind / 2)) / 2;
    const int x = std::min(column / 2, wide - 1), y = std::min(row / 2, high - 1);
    out[kind] = sky_[kind][std::size_t(y) * std::size_t(wide) + std::size_t(x)];
  }
  return out;
}

void ColourMosaic::measure_responses(const std::array<double, 4>& noise) {
  constexpr double min_snr = 20.0;  // for the four pixels of an evened block together
  constexpr std::size_t min_sources = 10;
  constexpr int rounds = 12;
  double most = -HUGE_VAL;
  for (const double v : values_)
    if (std::isfinite(v)) most = std::max(most, v);
  double variance = 0.0;
  for (const double n : noise) variance += n * n;
  const double min_light = min_snr * std::sqrt(variance);
  const int wide = columns_ / 2, high = rows_ / 2;
  using Light = std::array<double, 4>;
  const auto light_of = [&](int i, int j) {
    const auto sky = levels_around(2 * i, 2 * j);
    Light light{};
    for (std::size_t kind = 0; kind < 4; ++kind) {
      const double v = values_[std::size_t(2 * j + int(kind / 2)) * std::size_t(columns_) +
                               std::size_t(2 * i + int(kind % 2))];
      light[kind] = v < 0.9 * most ? v - double(sky[kind]) : std::nan("");
    }
    return light;
  };
  // Each bright block, and those around it.
  std::vector<std::array<Light, 9>> blocks;
  for (int j = 1; j + 1 < high; ++j)
    for (int i = 1; i + 1 < wide; ++i) {
      const Light middle = light_of(i, j);
      if (!(middle[0] + middle[1] + middle[2] + middle[3] > min_response * min_light)) continue;
      auto& around = blocks.emplace_back();
      for (int k = 0; k < 9; ++k) around[std::size_t(k)] = light_of(i + k % 3 - 1, j + k / 3 - 1);
    }
  // Sources lie anywhere in blocks: with even responses each kind has a quarter of the light around
  // the brightest blocks, if those are chosen by even responses, too.
  Light response{1.0, 1.0, 1.0, 1.0};
  for (int round = 0; round < rounds; ++round) {
    Light share{};
    std::size_t sources = 0;
    for (const auto& around : blocks) {
      Light light{};
      std::array<double, 9> sums{};
      double sum = 0.0;
      for (std::size_t k = 0; k < 9; ++k)
        for (std::size_t kind = 0; kind < 4; ++kind) {
          const double even = around[k][kind] / response[kind];
          sums[k] += even;
          light[kind] += even;
          sum += even;
        }
      if (!(sums[4] > min_light) || !(sum > 0) || std::ranges::max(sums) > sums[4]) continue;
      ++sources;
      for (std::size_t kind = 0; kind < 4; ++kind)
        share[kind] += std::clamp(light[kind] / sum, 0.0, 1.0);
    }
    if (sources < min_sources) return;
    double mean = 0.0;
    for (std::size_t kind = 0; kind < 4; ++kind) {
      response[kind] *= 4 * share[kind] / double(sources);
      mean += response[kind] / 4;
    }
    for (double& one : response) one = std::max(one / mean, min_response);
  }
  responses_ = response;
}

std::vector<double> ColourMosaic::evened() const {
  std::vector<double> out(values_.size());
  const auto response = responses_.value_or(std::array{1.0, 1.0, 1.0, 1.0});
  for (int y = 0; y < rows_; ++y)
    for (int x = 0; x < columns_; ++x) {
      const auto sky = levels_around(x, y);
      const double mean = (double(sky[0]) + double(sky[1]) + double(sky[2]) + double(sky[3])) / 4;
      const auto kind = std::size_t(x % 2 + 2 * (y % 2));
      const std::size_t i = std::size_t(y) * std::size_t(columns_) + std::size_t(x);
      out[i] = mean + (values_[i] - double(sky[kind])) / response[kind];
    }
  return out;
}

double ColourMosaic::min_evened(double value) const {
  const auto response = responses_.value_or(std::array{1.0, 1.0, 1.0, 1.0});
  const double mean = (median_[0] + median_[1] + median_[2] + median_[3]) / 4;
  double least = HUGE_VAL;
  for (std::size_t kind = 0; kind < 4; ++kind)
    least = std::min(least, mean + (value - median_[kind]) / response[kind]);
  return least;
}

}  // namespace dmise
