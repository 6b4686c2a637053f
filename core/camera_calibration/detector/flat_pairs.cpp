#include "core/camera_calibration/detector/flat_pairs.h"

#include <algorithm>
#include <cmath>

namespace dmise {
namespace {

constexpr double pair_outlier_sigmas = 6.0;
constexpr double max_light_difference = 0.05;  // between both flats of a pair, relative

/// A tile's values without outliers, at their places; NaN elsewhere.
struct TileValues {
  std::vector<double> values;
  double mean = 0.0, variance = 0.0, pixels = 0.0;

  TileValues(const std::vector<float>& image, const Tiles& tiles, std::size_t tile)
      : values(std::size_t(tiles.width) * std::size_t(tiles.height)) {
    std::vector<float> sample;
    for (int y = 0; y < tiles.height; ++y)
      for (int x = 0; x < tiles.width; ++x) {
        const float v = image[std::size_t(tiles.y0(tile) + y) * std::size_t(tiles.columns) +
                              std::size_t(tiles.x0(tile) + x)];
        values[std::size_t(y * tiles.width + x)] = double(v);
        if (std::isfinite(v)) sample.push_back(v);
      }
    if (sample.size() < values.size() / 2) return;
    const RobustLevel level = robust_level(sample);
    // Whole counts with little noise have no deviation in the median.
    const double most = pair_outlier_sigmas * level.sigma + 1;
    double sum = 0.0, squares = 0.0;
    for (double& v : values) {
      if (!(std::abs(v - level.level) <= most)) {
        v = std::nan("");
        continue;
      }
      const double off = v - level.level;
      sum += off, squares += off * off, ++pixels;
    }
    mean = level.level + sum / pixels;
    variance = (squares - sum * sum / pixels) / (pixels - 1);
  }
};

std::vector<FlatTile> tiles_of(const std::vector<float>& light, const Tiles& tiles,
                               Threads& threads) {
  std::vector<FlatTile> out(tiles.count());
  threads.for_ranges(out.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      if (!tiles.is_whole(t)) continue;
      const TileValues tile(light, tiles, t);
      if (tile.pixels < 16) continue;
      out[t] = {float(tile.mean), float(std::sqrt(tile.variance))};
    }
  });
  return out;
}

/// The difference of two flats without the offsets of columns, which are new in each frame.
std::vector<float> difference_of(const std::vector<float>& first, const std::vector<float>& second,
                                 double ratio, int columns) {
  std::vector<float> out(first.size());
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = float(double(first[i]) - ratio * double(second[i]));
  const RobustLevel all = robust_level(out);
  const double most = 2 * pair_outlier_sigmas * all.sigma + 1;
  std::vector<double> sum(std::size_t(columns), 0.0), count(std::size_t(columns), 0.0);
  for (std::size_t i = 0; i < out.size(); ++i) {
    const double v = double(out[i]) - all.level;
    if (!(std::abs(v) <= most)) continue;
    sum[i % std::size_t(columns)] += v;
    ++count[i % std::size_t(columns)];
  }
  for (std::size_t x = 0; x < sum.size(); ++x)
    sum[x] = all.level + (count[x] > 0 ? sum[x] / count[x] : 0.0);
  for (std::size_t i = 0; i < out.size(); ++i) out[i] -= float(sum[i % std::size_t(columns)]);
  return out;
}

/// Mean product of a tile's neighbours about its mean.
double covariance_of(const TileValues& tile, const Tiles& tiles) {
  double sum = 0.0, n = 0.0, along_column = 0.0;
  const auto add = [&](double a, double b, bool vertical) {
    const double product = (a - tile.mean) * (b - tile.mean);
    if (!std::isfinite(product)) return;
    sum += product, ++n;
    along_column += vertical;
  };
  const auto at = [&](int x, int y) { return tile.values[std::size_t(y * tiles.width + x)]; };
  for (int y = 0; y < tiles.height; ++y)
    for (int x = 0; x < tiles.width; ++x) {
      if (x + 1 < tiles.width) add(at(x, y), at(x + 1, y), false);
      if (y + 1 < tiles.height) add(at(x, y), at(x, y + 1), true);
    }
  // Removing the means of tiles and of columns makes independent pixels correlated by
  // -1 / (pixels - 1).
  const double of_columns = along_column / std::max(n, 1.0) / (tiles.rows - 1.0);
  return n > 0 ? sum / n + tile.variance * (1 / tile.pixels + of_columns) : 0.0;
}

std::vector<PairTile> pair_tiles(const std::vector<float>& difference, double ratio,
                                 const std::vector<FlatTile>& first,
                                 const std::vector<FlatTile>& second, const Tiles& tiles,
                                 Threads& threads) {
  std::vector<PairTile> out(tiles.count());
  // The difference is first - r second, where both have the signals S and S / r.
  const double variances = 1 + ratio * ratio, rows = tiles.rows;
  const double scale = rows / (rows - 1) / variances;
  threads.for_ranges(out.size(), 64, [&](std::size_t begin, std::size_t end) {
    for (std::size_t t = begin; t < end; ++t) {
      if (!tiles.is_whole(t)) continue;
      const TileValues tile(difference, tiles, t);
      if (tile.pixels < 16) continue;
      const double signal =
          (double(first[t].mean) + ratio * ratio * double(second[t].mean)) / variances;
      out[t] = {float(signal), float(tile.variance * scale),
                float(covariance_of(tile, tiles) / variances), float(tile.pixels)};
    }
  });
  return out;
}

double total_of(const std::vector<FlatTile>& tiles) {
  double sum = 0.0;
  for (const FlatTile& tile : tiles) sum += double(tile.mean);
  return sum;
}

}  // namespace

double FlatTiles::mean_of(std::size_t flat) const {
  double n = 0.0;
  for (const FlatTile& tile : tiles[flat]) n += tile.mean != 0.0f;
  return total_of(tiles[flat]) / std::max(n, 1.0);
}

std::vector<float> light_of(const CalibrationSet& set, const CalibrationFrame& flat,
                            const std::vector<float>& bias_mean) {
  auto light = set.values(flat);
  for (std::size_t i = 0; i < bias_mean.size(); ++i) light[i] -= bias_mean[i];
  return light;
}

FlatTiles measure_flats(const CalibrationSet& set, const std::vector<float>& bias_mean,
                        Threads& threads) {
  FlatTiles out;
  std::vector<float> before;  // the flat before, if it has no partner yet
  for (const CalibrationFrame& flat : set.of(FrameKind::flat)) {
    auto light = light_of(set, flat, bias_mean);
    out.flats.push_back(&flat);
    out.tiles.push_back(tiles_of(light, set.tiles(), threads));
    const std::size_t at = out.flats.size() - 1;
    if (!before.empty()) {
      const double ratio = total_of(out.tiles[at - 1]) / total_of(out.tiles[at]);
      if (out.flats[at - 1]->exposure_s == flat.exposure_s &&
          std::abs(ratio - 1) < max_light_difference) {
        const auto difference = difference_of(before, light, ratio, set.columns());
        out.pairs.push_back({at - 1, at,
                             pair_tiles(difference, ratio, out.tiles[at - 1], out.tiles[at],
                                        set.tiles(), threads)});
        light.clear();
      }
    }
    before = std::move(light);
  }
  return out;
}

}  // namespace dmise
