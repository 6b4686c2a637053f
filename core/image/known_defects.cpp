#include "core/image/known_defects.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

#include "core/base/numeric/quantile.h"
#include "core/base/numeric/rng.h"
#include "core/detector/hot_pixels.h"

namespace dmise {
namespace {

/// Places of the hot pixels whose charge is seen.
std::vector<std::uint32_t> hot_pixels_seen(const FrameHeader& header, std::size_t pixels) {
  if (!header.detector) return {};
  const HotPixels& effect = *header.detector;
  if (!effect.applies(*header.detector)) return {};
  const double noise_e =
      std::hypot(header.read_noise_e, std::sqrt(header.dark_e_per_s * header.exposure_s));
  const RngKey key = rng_key(header.seed, header.sensor, 0, HotPixels::facts.name);
  std::vector<std::uint32_t> seen;
  for (const HotPixel& hot : effect.among(pixels, key))
    if (double(hot.dark_e_per_s) * header.exposure_s > noise_e) seen.push_back(hot.pixel);
  return seen;
}

/// The median of the pixels around one that have a value; the pixel's own count without any.
std::uint16_t level_around(const Frame& frame, int x, int y) {
  const CountImage& counts = frame.counts;
  std::vector<double> around;
  for (int v = std::max(y - 1, 0); v <= std::min(y + 1, counts.rows - 1); ++v)
    for (int u = std::max(x - 1, 0); u <= std::min(x + 1, counts.columns - 1); ++u)
      if (frame.unusable.at(u, v) == 0) around.push_back(counts.at(u, v));
  return around.empty() ? counts.at(x, y) : std::uint16_t(median_of(std::move(around)));
}

}  // namespace

std::optional<Frame> without_hot_pixels(const Frame& frame) {
  const auto hot = hot_pixels_seen(frame.header, frame.counts.pixels.size());
  if (hot.empty()) return std::nullopt;
  Frame out = frame;
  const int columns = frame.counts.columns;
  if (out.unusable.pixels.empty()) out.unusable = PixelMask(columns, frame.counts.rows);
  for (const std::uint32_t i : hot) out.unusable.pixels[i] = 1;
  for (const std::uint32_t i : hot)
    out.counts.pixels[i] = level_around(out, int(i) % columns, int(i) / columns);
  return out;
}

}  // namespace dmise
