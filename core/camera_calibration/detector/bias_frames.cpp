#include "core/camera_calibration/detector/bias_frames.h"

#include <cmath>

#include "core/base/numeric/chi_square.h"
#include "core/camera_calibration/detector/pixel_series.h"

namespace dmise {
namespace {

constexpr double rounding_variance = 1.0 / 12;
constexpr double outlier_sigmas = 8.0;

/// The offset of each column of a frame against a reference, and the mean of all.
struct ColumnOffsets {
  std::vector<double> column;
  double mean = 0.0;
};

ColumnOffsets offsets_of(const std::vector<float>& values, const std::vector<float>& reference,
                         int columns) {
  std::vector<float> difference(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) difference[i] = values[i] - reference[i];
  const RobustLevel all = robust_level(difference);
  const double most = outlier_sigmas * all.sigma + 1;
  ColumnOffsets out{std::vector<double>(std::size_t(columns), 0.0)};
  std::vector<double> counts(std::size_t(columns), 0.0);
  for (std::size_t i = 0; i < difference.size(); ++i) {
    const double d = double(difference[i]) - all.level;
    if (!(std::abs(d) <= most)) continue;
    out.column[i % std::size_t(columns)] += d;
    ++counts[i % std::size_t(columns)];
  }
  double used = 0.0;
  for (std::size_t x = 0; x < out.column.size(); ++x) {
    if (counts[x] > 0) out.column[x] = all.level + out.column[x] / counts[x];
    out.mean += counts[x] > 0 ? out.column[x] : 0.0;
    used += counts[x] > 0;
  }
  out.mean /= std::max(used, 1.0);
  for (std::size_t x = 0; x < out.column.size(); ++x)
    if (!(counts[x] > 0)) out.column[x] = out.mean;
  return out;
}

MeasuredValue root_of(MeasuredValue variance) {
  const double root = std::sqrt(std::max(variance.value, 0.0));
  // If noise hides the variance, the deviation of its root is that of the variance's own size.
  const double sigma =
      root > 0 ? variance.sigma / (2 * root) : std::sqrt(std::max(variance.sigma, 0.0));
  return {root, std::min(sigma, std::sqrt(std::max(variance.sigma, 0.0)))};
}

/// Sums of a strip of columns.
enum Sum { count, mean, variance, fourth, columns, column_variance, pairs, pixel_scatter, sums };
using BiasSums = StripSums<sums>;

/// Adds the pixels of each column to the sums of its strip.
void add_pixels(const CalibrationSet& set, const PixelSeries& series, double sigma,
                BiasMeasurement& out, std::vector<BiasSums>& strips) {
  const Tiles& tiles = set.tiles();
  const double rows = tiles.rows, n = out.frames;
  const double freedom = rows / (rows - 1);
  for (std::size_t i = 0; i < out.mean.size(); ++i) {
    const PixelSeries::Result pixel = series.at(i);
    out.mean[i] = float(double(out.mean[i]) + pixel.mean);
    if (!std::isfinite(pixel.mean)) continue;
    BiasSums& s = strips[tiles.strip_of_column(int(i % std::size_t(tiles.columns)))];
    s[count] += 1;
    s[mean] += double(out.mean[i]);
    const double v = pixel.variance * sigma * sigma * freedom;
    s[variance] += v;
    if (!pixel.struck) s[fourth] += v * v * (n - 1) / (n + 1);
  }
}

/// Scatter of the mean frame's pixels along parts of a column, and of its columns in groups.
void add_pattern(const CalibrationSet& set, const BiasMeasurement& out,
                 std::vector<BiasSums>& strips, std::vector<StripSums<2>>& of_columns) {
  constexpr int part = 32, group = 8;
  const Tiles& tiles = set.tiles();
  const auto columns_of = std::size_t(tiles.columns);
  const RobustLevel all = robust_level(out.mean);
  const double most = 2 * outlier_sigmas * all.sigma + 1;
  std::vector<double> sum(columns_of, 0.0), used(columns_of, 0.0);
  for (int x = 0; x < tiles.columns; ++x)
    for (int y = 0; y + part <= tiles.rows; y += part) {
      double total = 0.0, squares = 0.0, n = 0.0;
      for (int k = 0; k < part; ++k) {
        const double v =
            double(out.mean[std::size_t(y + k) * columns_of + std::size_t(x)]) - all.level;
        if (!(std::abs(v) < most)) continue;
        total += v, squares += v * v, ++n;
      }
      sum[std::size_t(x)] += total, used[std::size_t(x)] += n;
      if (n < 2) continue;
      BiasSums& s = strips[tiles.strip_of_column(x)];
      s[pairs] += n - 1;
      s[pixel_scatter] += squares - total * total / n;
    }
  for (int x = 0; x + group <= tiles.columns; x += group) {
    double total = 0.0, squares = 0.0, n = 0.0;
    for (int k = x; k < x + group; ++k) {
      if (!(used[std::size_t(k)] > 0.5 * tiles.rows)) continue;
      const double v = sum[std::size_t(k)] / used[std::size_t(k)];
      total += v, squares += v * v, ++n;
    }
    if (n < 2) continue;
    auto& s = of_columns[tiles.strip_of_column(x)];
    s[0] += n - 1;
    s[1] += squares - total * total / n;
  }
}

/// Sums of the variance of each column's offset from frame to frame.
void add_columns(const CalibrationSet& set, const std::vector<ColumnOffsets>& offsets,
                 std::vector<BiasSums>& strips) {
  const double n = double(offsets.size());
  const double freedom = double(set.columns()) / (set.columns() - 1.0);
  for (int x = 0; x < set.columns(); ++x) {
    double total = 0.0, squares = 0.0;
    for (const ColumnOffsets& frame : offsets) {
      const double v = frame.column[std::size_t(x)] - frame.mean;
      total += v, squares += v * v;
    }
    BiasSums& s = strips[set.tiles().strip_of_column(x)];
    s[columns] += 1;
    s[column_variance] += (squares - total * total / n) / (n - 1) * freedom;
  }
}

/// Whether the level of frames scatters more than their pixels' and columns' noise; else 0.
double drift_of(const std::vector<ColumnOffsets>& offsets, double variance_of_mean) {
  double total = 0.0, squares = 0.0;
  const double n = double(offsets.size());
  for (const ColumnOffsets& frame : offsets)
    total += frame.mean, squares += frame.mean * frame.mean;
  const double scatter = squares - total * total / n;
  return scatter > chi_square_of_normal(3.1, n - 1) * variance_of_mean
             ? std::sqrt(scatter / (n - 1))
             : 0.0;
}

void estimate(const CalibrationSet& set, const std::vector<BiasSums>& strips,
              const std::vector<StripSums<2>>& of_columns, BiasMeasurement& out) {
  const double rounding = set.is_whole() ? rounding_variance : 0.0;
  const double rows = set.rows(), n = out.frames;
  const auto variance_of = [](const BiasSums& s) { return s[variance] / s[count]; };
  const auto column_variance_of = [&](const BiasSums& s) {
    return s[column_variance] / s[columns] - variance_of(s) / rows;
  };
  const auto pixel_offset_of = [&](const BiasSums& s) {
    return s[pixel_scatter] / s[pairs] - variance_of(s) / n;
  };
  out.level = jackknifed(strips, [](const BiasSums& s) { return s[mean] / s[count]; });
  out.floor_variance = jackknifed(strips, variance_of).value;
  out.read_noise =
      root_of(jackknifed(strips, [&](const BiasSums& s) { return variance_of(s) - rounding; }));
  out.column_noise = root_of(jackknifed(strips, column_variance_of));
  out.pixel_offset = root_of(jackknifed(strips, pixel_offset_of));
  if (n >= 4)
    out.read_noise_spread = root_of(jackknifed(strips, [&](const BiasSums& s) {
      // Without its column's mean a pixel of variance s has (1 - 2 / rows) s + V / rows.
      const double all = variance_of(s), v = all - rounding, less = 1 - 1 / rows;
      const double seen = s[fourth] / s[count] * less * less;
      const double own = (seen - 2 * all * all * less / rows + std::pow(all / rows, 2)) /
                         std::pow(1 - 2 / rows, 2);
      const double v4 = own - 2 * v * rounding - rounding * rounding;
      return v > 0 && v4 > 0 ? 0.25 * std::log(v4 / (v * v)) : 0.0;
    }));
  const double noise_of_column =
      std::pow(out.column_noise.value, 2) / n +
      (std::pow(out.pixel_offset.value, 2) + out.floor_variance / n) / rows;
  out.column_offset = root_of(
      jackknifed(of_columns, [&](const StripSums<2>& s) { return s[1] / s[0] - noise_of_column; }));
}

}  // namespace

BiasMeasurement measure_bias(const CalibrationSet& set, const std::vector<CalibrationFrame>& frames,
                             double exposure_s) {
  BiasMeasurement out{.frames = int(frames.size()), .exposure_s = exposure_s};
  out.mean = set.values(frames.front());
  const std::vector<float> reference = out.mean;
  PixelSeries series(reference.size());
  std::vector<ColumnOffsets> offsets;
  std::vector<float> aligned(reference.size());
  const double sigma = std::max(frames.front().noise, 0.3);
  std::size_t at_zero = 0;
  for (const CalibrationFrame& frame : frames) {
    const auto values = &frame == &frames.front() ? reference : set.values(frame);
    offsets.push_back(offsets_of(values, reference, set.columns()));
    const auto& column = offsets.back().column;
    for (std::size_t i = 0; i < values.size(); ++i) {
      aligned[i] = values[i] - reference[i] - float(column[i % column.size()]);
      at_zero += values[i] <= 0;
    }
    series.add(aligned, sigma);
  }
  out.clipped = double(at_zero) > 1e-3 * double(reference.size()) * out.frames;
  std::vector<BiasSums> strips(std::size_t(set.tiles().strips));
  std::vector<StripSums<2>> of_columns(strips.size());
  add_pixels(set, series, sigma, out, strips);
  // The mean frame has the reference's columns: moved to the mean of all frames.
  std::vector<double> column(std::size_t(set.columns()), 0.0);
  for (const ColumnOffsets& frame : offsets)
    for (std::size_t x = 0; x < column.size(); ++x) column[x] += frame.column[x] / out.frames;
  for (std::size_t i = 0; i < out.mean.size(); ++i) out.mean[i] += float(column[i % column.size()]);
  for (int x = 0; x < set.columns(); ++x) {
    BiasSums& s = strips[set.tiles().strip_of_column(x)];
    s[mean] += column[std::size_t(x)] * set.rows();
  }
  add_columns(set, offsets, strips);
  add_pattern(set, out, strips, of_columns);
  estimate(set, strips, of_columns, out);
  const double variance_of_mean =
      (out.floor_variance / set.rows() + std::pow(out.column_noise.value, 2)) / set.columns();
  out.drift_dn = drift_of(offsets, variance_of_mean);
  out.level.sigma = std::hypot(out.level.sigma, out.drift_dn / std::sqrt(double(out.frames)));
  return out;
}

}  // namespace dmise
