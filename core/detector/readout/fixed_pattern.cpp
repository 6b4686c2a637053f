#include "core/detector/readout/fixed_pattern.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/effects/plan_facts.h"

namespace dmise {
namespace {

// Draws of a pixel, and of a column in its place.
enum Draw : std::uint32_t { pixel_gain, pixel_offset, column_gain, column_offset };

/// Adds scale times fixed normal deviates.
void add_normals(const RngKey& key, Draw draw, std::size_t first, double scale,
                 std::span<float> sums) {
  constexpr std::size_t part = 1024;
  std::array<float, part> normals;
  if (!(scale > 0.0)) return;
  for (std::size_t i = 0; i < sums.size(); i += part) {
    const std::size_t n = std::min(part, sums.size() - i);
    rng_normals(key, std::uint32_t(first + i), draw, std::span(normals).first(n));
    for (std::size_t j = 0; j < n; ++j) sums[i + j] += float(scale) * normals[j];
  }
}

}  // namespace

double FixedPattern::cost_s(int level, const PlanFacts& f) { return level * 9e-9 * f.pixels(); }

std::span<const ParameterOf<FixedPattern>> FixedPattern::parameters() {
  static constexpr ParameterOf<FixedPattern> table[] = {
      {"pixel_gain_rms", "PIXGAIN", "rms of the pixels' gains, relative",
       &FixedPattern::pixel_gain_rms, 0.0, 0.2},
      {"column_gain_rms", "COLGAIN", "rms of the columns' gains, relative",
       &FixedPattern::column_gain_rms, 0.0, 0.2},
      {"pixel_offset_e", "PIXOFF", "[e-] rms of the pixels' fixed offsets",
       &FixedPattern::pixel_offset_e, 0.0, 1e6},
      {"column_offset_e", "COLOFF", "[e-] rms of the columns' fixed offsets",
       &FixedPattern::column_offset_e, 0.0, 1e6}};
  return table;
}

FixedPattern::Prepared FixedPattern::prepare(const ExposureFacts& exposed) const {
  const auto count = std::size_t(exposed.light.columns);
  std::vector<float> gains(count, 1.0f), offsets_e(count);
  add_normals(exposed.fixed_key, column_gain, 0, column_gain_rms, gains);
  add_normals(exposed.fixed_key, column_offset, 0, column_offset_e, offsets_e);
  Prepared columns(count);
  for (std::size_t x = 0; x < count; ++x) columns[x] = {std::max(gains[x], 0.0f), offsets_e[x]};
  return columns;
}

void FixedPattern::apply(const ExposureFacts& exposed, const Prepared& columns,
                         Piece& piece) const {
  constexpr std::size_t part = 1024;
  std::array<float, part> gains, offsets_e;
  const auto e = piece.electrons;
  std::size_t x = piece.first % columns.size();
  for (std::size_t i = 0; i < e.size(); i += part) {
    const std::size_t n = std::min(part, e.size() - i), first = piece.first + i;
    gains.fill(1.0f);
    offsets_e.fill(0.0f);
    add_normals(exposed.fixed_key, pixel_gain, first, pixel_gain_rms, std::span(gains).first(n));
    add_normals(exposed.fixed_key, pixel_offset, first, pixel_offset_e,
                std::span(offsets_e).first(n));
    for (std::size_t j = 0; j < n; ++j) {
      const Column& column = columns[x];
      e[i + j] = e[i + j] * std::max(gains[j], 0.0f) * column.gain + offsets_e[j] + column.offset_e;
      x = x + 1 < columns.size() ? x + 1 : 0;
    }
  }
}

ErrorBound FixedPattern::error(int, const PlanFacts& f) const {
  // As of `prnu`, and of offsets in a pixel's noise, five and a half deviations; columns are not
  // independent pixels along a trail.
  const double gain = std::hypot(pixel_gain_rms, column_gain_rms);
  const double offset_e = std::hypot(pixel_offset_e, column_offset_e);
  ErrorBound error = f.without_light([&](const SkySample& s) {
    return 5.5 * (gain * (s.sky_e + f.dark_e + 0.5 * s.noise_e) + offset_e);
  });
  error.noise = 5.5 * gain;  // which they scale; offsets are no noise from frame to frame
  const double pixels_e = 4.0 * offset_e * std::sqrt(12.6) * f.sigma_px();
  error.photometry_mag = 1.086 * (4.0 * gain + pixels_e / f.faintest_source_e());
  const double along_px = std::max(1.0, f.fwhm_px) + 0.29 * f.longest_trail_px;
  error.position_px = error.photometry_mag / 1.086 * along_px;
  return error;
}

}  // namespace dmise
