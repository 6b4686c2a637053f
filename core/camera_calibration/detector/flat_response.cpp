#include "core/camera_calibration/detector/flat_response.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/camera_calibration/detector/pixel_corrections.h"

namespace dmise {
namespace {

constexpr double response_outlier_sigmas = 6.0;

/// A tile of two images without its mean, slopes and bends, relative to the means.
struct TileCovariance {
  double covariance = 0.0, pixels = 0.0, mean = 0.0;  // mean of the first
  double variance = 0.0;                              // pixels' variance in the mean of both
  std::vector<float> deviations;                      // one for each pixel, in the mean of both
};

/// A tile's relative deviations from its mean, slopes and bends: vignetting bends a tile by as much
/// as even pixels differ.
std::vector<double> without_bend(const std::vector<float>& image, const Tiles& tiles,
                                 std::size_t tile, double& mean) {
  const int w = tiles.width, h = tiles.height;
  std::vector<double> v(std::size_t(w) * std::size_t(h));
  double sum = 0.0, n = 0.0;
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const double value =
          double(image[std::size_t(tiles.y0(tile) + y) * std::size_t(tiles.columns) +
                       std::size_t(tiles.x0(tile) + x)]);
      v[std::size_t(y * w + x)] = value;
      if (std::isfinite(value)) sum += value, ++n;
    }
  mean = n > 0 ? sum / n : 0.0;
  if (!(mean > 0)) return {};
  // Along x, along y, and their squares: orthogonal over a whole tile.
  const auto terms_at = [&](int x, int y) {
    const double u = x - 0.5 * (w - 1), z = y - 0.5 * (h - 1);
    return std::array{u, z, u * u - (w * w - 1) / 12.0, z * z - (h * h - 1) / 12.0};
  };
  std::array<double, 4> sums{}, squares{};
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      double& value = v[std::size_t(y * w + x)];
      value = value / mean - 1;
      if (!std::isfinite(value)) continue;
      const auto terms = terms_at(x, y);
      for (std::size_t k = 0; k < terms.size(); ++k) {
        sums[k] += terms[k] * value;
        squares[k] += terms[k] * terms[k];
      }
    }
  for (int y = 0; y < h; ++y)
    for (int x = 0; x < w; ++x) {
      const auto terms = terms_at(x, y);
      for (std::size_t k = 0; k < terms.size(); ++k)
        v[std::size_t(y * w + x)] -= sums[k] / squares[k] * terms[k];
    }
  return v;
}

TileCovariance covariance_of_halves(const std::vector<float>& first,
                                    const std::vector<float>& second, const Tiles& tiles,
                                    std::size_t tile) {
  TileCovariance out;
  double other = 0.0;
  const auto a = without_bend(first, tiles, tile, out.mean);
  const auto b = without_bend(second, tiles, tile, other);
  if (a.empty() || b.empty()) return {};
  std::vector<float> sizes;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (const auto s = float(std::abs(a[i] + b[i])); std::isfinite(s)) sizes.push_back(s);
  if (sizes.size() < 16) return {};
  const double most = response_outlier_sigmas * sigma_of_median * double(median_of(sizes));
  double sum = 0.0, squares = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    const double mean = 0.5 * (a[i] + b[i]);
    out.deviations.push_back(float(mean));
    if (!(std::abs(2 * mean) <= most)) continue;
    sum += a[i] * b[i];
    squares += mean * mean;
    ++out.pixels;
  }
  constexpr double of_bend = 5.0;
  out.covariance = sum / (out.pixels - of_bend);
  out.variance = squares / (out.pixels - of_bend);
  return out;
}

/// Takes ordinary dark current off; hot pixels, which may have been full in darks, have no value.
void take_off_dark(const DarkMeasurement& dark, double time_s, std::vector<float>& values) {
  const double current = dark.current.value;
  for (std::size_t i = 0; i < dark.rates.size(); ++i)
    values[i] = double(dark.rates[i]) - current > dark.threshold
                    ? std::nanf("")
                    : float(double(values[i]) - time_s * current);
}

/// Writes what is known of a tile's pixels; of others it stays 0.
void set_pixels(const Tiles& tiles, std::size_t tile, const std::vector<float>& deviations,
                std::vector<float>& pixels) {
  for (std::size_t k = 0; k < deviations.size(); ++k) {
    const std::size_t x = std::size_t(tiles.x0(tile)) + k % std::size_t(tiles.width),
                      y = std::size_t(tiles.y0(tile)) + k / std::size_t(tiles.width);
    if (std::abs(deviations[k]) < 0.5F) pixels[y * std::size_t(tiles.columns) + x] = deviations[k];
  }
}

}  // namespace

FlatResponse measure_response(const CalibrationSet& set, const FlatTiles& flats,
                              const Saturation& saturation, const BiasMeasurement& bias,
                              const DarkMeasurement* dark, double loss_per_dn,
                              MeasuredValue coupling) {
  FlatResponse out;
  std::vector<float> halves[2];
  double frames_of[2] = {0.0, 0.0};
  // Flats near the brightest: faint ones add noise of the bias and no light.
  constexpr double min_light = 0.2;
  double brightest = 0.0;
  for (std::size_t f = 0; f < flats.flats.size(); ++f)
    if (saturation.usable[f]) brightest = std::max(brightest, flats.mean_of(f));
  for (std::size_t f = 0; f < flats.flats.size(); ++f) {
    const double mean = flats.mean_of(f);
    if (!saturation.usable[f] || !(mean > min_light * brightest)) continue;
    auto& half = halves[out.frames % 2];
    ++frames_of[out.frames % 2];
    ++out.frames;
    auto values = light_of(set, *flats.flats[f], bias.mean);
    uncouple(coupling.value, set.columns(), values);
    straighten(loss_per_dn, values);
    if (dark) take_off_dark(*dark, flats.flats[f]->exposure_s.value_or(0.0), values);
    if (half.empty())
      half = std::move(values);
    else
      for (std::size_t i = 0; i < half.size(); ++i) half[i] += values[i];
  }
  if (out.frames < 2) return out;
  out.field = measure_lens_light(set, halves[0], halves[1]);
  const Tiles& tiles = set.tiles();
  std::vector<StripSums<2>> strips(std::size_t(tiles.strips));
  double seen_variance = 0.0;
  out.pixels.assign(halves[0].size(), 0.0F);
  for (std::size_t t = 0; t < tiles.count(); ++t) {
    if (!tiles.is_whole(t)) continue;
    const auto tile = covariance_of_halves(halves[0], halves[1], tiles, t);
    if (!(tile.pixels > 0)) continue;
    // The noise of the bias's mean frame is in both halves.
    const double of_bias =
        bias.frames > 0 ? bias.floor_variance / bias.frames * std::pow(frames_of[0] / tile.mean, 2)
                        : 0.0;
    auto& s = strips[tiles.strip_of(t)];
    s[0] += tile.pixels;
    s[1] += tile.pixels * (tile.covariance - of_bias);
    seen_variance += tile.pixels * tile.variance;
    set_pixels(tiles, t, tile.deviations, out.pixels);
  }
  const MeasuredValue variance = jackknifed(strips, mean_of_sums);
  const double rms = std::sqrt(std::max(variance.value, 0.0));
  // What is seen of a pixel holds noise: its share is taken off.
  double pixels = 0.0;
  for (const auto& strip : strips) pixels += strip[0];
  const double share =
      seen_variance > 0 ? std::clamp(rms * rms * pixels / seen_variance, 0.0, 1.0) : 0.0;
  for (float& p : out.pixels) p = float(1 + share * double(p));
  // Coupling a smooths the pattern to about 1 - 4 a, which uncoupling gives back.
  out.prnu = {rms, rms > 0 ? std::hypot(variance.sigma / (2 * rms), 4 * rms * coupling.sigma)
                           : std::sqrt(variance.sigma)};
  return out;
}

}  // namespace dmise
