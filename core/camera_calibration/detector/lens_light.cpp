#include "core/camera_calibration/detector/lens_light.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/algebra/positive_matrix.h"

namespace dmise {
namespace {

constexpr double light_outlier_sigmas_of_tile = 6.0;
constexpr int field_nodes = 9;

std::size_t mosaic_kind_of(const CalibrationSet& set, std::size_t tile) {
  if (!set.is_mosaic()) return 0;
  const Tiles& t = set.tiles();
  return std::size_t(t.x0(tile) >= (t.columns + 1) / 2) +
         2 * std::size_t(t.y0(tile) >= (t.rows + 1) / 2);
}

constexpr std::size_t field_terms = 5;
using FieldTerms = std::array<double, field_terms>;

/// Powers of the square of a pixel's distance, as it was recorded, from the frame's middle over
/// that of the corner.
FieldTerms field_terms_at(const CalibrationSet& set, int column, int row) {
  const Tiles& t = set.tiles();
  const auto recorded = [&](int at, int count) {
    const int half = (count + 1) / 2;
    return !set.is_mosaic() ? at : at < half ? 2 * at : 2 * (at - half) + 1;
  };
  const double x = recorded(column, t.columns) - 0.5 * (t.columns - 1),
               y = recorded(row, t.rows) - 0.5 * (t.rows - 1),
               square = (x * x + y * y) /
                        (0.25 * (std::pow(t.columns - 1, 2) + std::pow(t.rows - 1, 2)));
  FieldTerms terms{1.0};
  for (std::size_t k = 1; k < terms.size(); ++k) terms[k] = terms[k - 1] * square;
  return terms;
}

/// Light of a tile, and the means of the terms over its pixels, so that a polynomial holds for it.
struct TileLight {
  double light = 0.0;  // 0 if there is none
  FieldTerms terms{};
};

/// Means of a tile's pixels without outliers.
TileLight light_of_tile(const CalibrationSet& set, const std::vector<float>& first,
                        const std::vector<float>& second, std::size_t tile) {
  const Tiles& t = set.tiles();
  const auto for_pixels = [&](auto&& use) {
    for (int y = t.y0(tile); y < t.y0(tile) + t.height; ++y)
      for (int x = t.x0(tile); x < t.x0(tile) + t.width; ++x) {
        const std::size_t i = std::size_t(y) * std::size_t(t.columns) + std::size_t(x);
        if (const float v = first[i] + second[i]; std::isfinite(v)) use(x, y, v);
      }
  };
  std::vector<float> sample;
  for_pixels([&](int, int, float v) { sample.push_back(v); });
  if (sample.empty()) return {};
  const RobustLevel level = robust_level(sample);
  // Whole counts with little noise have no deviation in the median.
  const double most = light_outlier_sigmas_of_tile * level.sigma + 1;
  TileLight out;
  double n = 0.0;
  for_pixels([&](int x, int y, float v) {
    if (std::abs(double(v) - level.level) > most) return;
    out.light += double(v), ++n;
    const FieldTerms terms = field_terms_at(set, x, y);
    for (std::size_t k = 0; k < terms.size(); ++k) out.terms[k] += terms[k];
  });
  out.light /= n;
  for (double& term : out.terms) term /= n;
  return out;
}

/// Light of all tiles, each kind of pixels over its own mean.
std::vector<TileLight> relative_light(const CalibrationSet& set, const std::vector<float>& first,
                                      const std::vector<float>& second) {
  std::vector<TileLight> light(set.tiles().count());
  std::array<double, 4> sum{}, count{};
  for (std::size_t t = 0; t < light.size(); ++t) {
    if (!set.tiles().is_whole(t)) continue;
    light[t] = light_of_tile(set, first, second, t);
    if (light[t].light == 0.0) continue;
    const std::size_t kind = mosaic_kind_of(set, t);
    sum[kind] += light[t].light, ++count[kind];
  }
  for (std::size_t t = 0; t < light.size(); ++t)
    if (light[t].light != 0.0) {
      const std::size_t kind = mosaic_kind_of(set, t);
      light[t].light *= count[kind] / sum[kind];
    }
  return light;
}

/// Normal equations of a polynomial in the square of the radius over that of the corner.
using FieldSums = StripSums<field_terms * field_terms + field_terms>;

/// The polynomial at the nodes; empty if the frame does not determine it.
std::vector<double> nodes_of(const FieldSums& sums) {
  std::vector<double> matrix(sums.begin(), sums.begin() + field_terms * field_terms);
  if (!invert_positive(matrix, int(field_terms))) return {};
  std::vector<double> out(field_nodes, 0.0);
  for (std::size_t i = 0; i < field_terms; ++i) {
    double coefficient = 0.0;
    for (std::size_t j = 0; j < field_terms; ++j)
      coefficient += matrix[i * field_terms + j] * sums[field_terms * field_terms + j];
    for (std::size_t n = 0; n < out.size(); ++n)
      out[n] += coefficient * std::pow(double(n) / (field_nodes - 1), 2.0 * double(i));
  }
  return out;
}

}  // namespace

std::vector<FieldLight> measure_lens_light(const CalibrationSet& set,
                                           const std::vector<float>& first,
                                           const std::vector<float>& second) {
  const Tiles& tiles = set.tiles();
  const double corner = std::hypot(0.5 * (tiles.columns - 1), 0.5 * (tiles.rows - 1));
  const auto light = relative_light(set, first, second);
  // Corners lie in few strips, so that these do not show well how their tiles scatter: tiles are
  // also left out in parts from all over the frame.
  constexpr std::size_t field_parts = 61;
  std::vector<FieldSums> strips(std::size_t(tiles.strips)), parts(field_parts);
  FieldSums all{};
  for (std::size_t t = 0; t < light.size(); ++t) {
    if (!(light[t].light > 0)) continue;
    const FieldTerms& terms = light[t].terms;
    for (FieldSums* s : {&strips[tiles.strip_of(t)], &parts[t % field_parts]})
      for (std::size_t i = 0; i < field_terms; ++i) {
        for (std::size_t j = 0; j < field_terms; ++j)
          (*s)[i * field_terms + j] += terms[i] * terms[j];
        (*s)[field_terms * field_terms + i] += terms[i] * light[t].light;
      }
  }
  for (const auto& strip : strips)
    for (std::size_t k = 0; k < all.size(); ++k) all[k] += strip[k];
  const auto whole = nodes_of(all);
  if (whole.empty()) return {};
  const auto relative_to = [&](std::size_t top, std::size_t n) {
    const auto ratio = [&](const FieldSums& sums) {
      const auto values = nodes_of(sums);
      return values.empty() ? whole[n] / whole[top] : values[n] / values[top];
    };
    const MeasuredValue by_strips = jackknifed(strips, ratio);
    return MeasuredValue{by_strips.value,
                         std::max(by_strips.sigma, jackknifed(parts, ratio).sigma)};
  };
  // The greatest of noisy values is too great: the axis is the brightest unless another is by more.
  constexpr double brighter_sigmas = 3.0;
  auto top = std::size_t(std::ranges::max_element(whole) - whole.begin());
  if (const MeasuredValue m = relative_to(0, top); m.value - 1 < brighter_sigmas * m.sigma) top = 0;
  std::vector<FieldLight> out;
  for (std::size_t n = 0; n < whole.size(); ++n)
    out.push_back({corner * double(n) / (field_nodes - 1), relative_to(top, n)});
  return out;
}

}  // namespace dmise
