#include "core/sequences/filtered_sequence.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include "core/base/numeric/quantile.h"
#include "core/base/units.h"
#include "core/detection/frame_scene.h"
#include "core/detection/known/star_motion.h"
#include "core/detection/make_report.h"
#include "core/detection/pixels/detection_limits.h"
#include "core/detection/source/point_snr.h"
#include "core/detection/source/scene.h"
#include "core/sequences/hot_pixels.h"

namespace dmise {
namespace {

constexpr float min_known = 0.5F;             // share of a point's weight
constexpr double clipped_reach_sigmas = 4.0;  // around clipped ones, whose wings vary

/// What a scene refers to.
struct SceneParts {
  const SequenceFrame& frame;
  const Background& background;
  StarMotion motion;

  SceneParts(const SequenceFrame& f, const Background& b)
      : frame(f), background(b), motion(f.header, f.counts.columns, f.counts.rows) {}
  Scene scene(const PixelMask* unusable) const {
    return frame_scene(frame.counts, background, motion, frame.header, unusable);
  }
};

PsfField psf_of(const SceneParts& parts, const PixelMask* unusable, Threads& threads) {
  Scene scene = parts.scene(unusable);
  use_psf_of_stars(scene, threads);
  return scene.psf;
}

std::vector<PlateSource> stars_of(const SceneParts& parts, Threads& threads) {
  const FrameHeader& h = parts.frame.header;
  const StarSourceSettings settings{.gain_e_per_dn = h.gain_e_per_dn,
                                    .saturation_dn = lowest_clipped_dn(h),
                                    .psf_fwhm_px = h.psf_fwhm_px,
                                    .most = 1000,
                                    .motion = &parts.motion,
                                    .unknown_mount = h.mount == "unknown"};
  return find_star_sources(parts.frame.counts, settings, threads);
}

/// Marks what is not known around a pixel.
void forget_around(PointAmplitude& light, int x, int y, double reach_px) {
  const int reach = int(std::ceil(reach_px));
  for (int v = std::max(y - reach, 0); v <= std::min(y + reach, light.rows - 1); ++v)
    for (int u = std::max(x - reach, 0); u <= std::min(x + reach, light.columns - 1); ++u)
      if (std::hypot(u - x, v - y) <= reach_px)
        light.at(u, v) = std::numeric_limits<float>::quiet_NaN();
}

/// Share of the weight of points that is left without the pixels that have no value.
KnownShare known_share(const PixelMask& no_value, double sigma_px) {
  Image<float, struct LostShareCarrier> lost(no_value.columns, no_value.rows);
  const int reach = int(std::ceil(3 * sigma_px));
  const double peak = 1 / (pi * sigma_px * sigma_px);  // the squared filter's, over its sum
  for (int y = 0; y < lost.rows; ++y)
    for (int x = 0; x < lost.columns; ++x) {
      if (!no_value.at(x, y)) continue;
      for (int v = std::max(y - reach, 0); v <= std::min(y + reach, lost.rows - 1); ++v)
        for (int u = std::max(x - reach, 0); u <= std::min(x + reach, lost.columns - 1); ++u)
          lost.at(u, v) += float(
              peak * std::exp(-((u - x) * (u - x) + (v - y) * (v - y)) / (sigma_px * sigma_px)));
    }
  KnownShare known(lost.columns, lost.rows);
  for (std::size_t p = 0; p < lost.pixels.size(); ++p)
    known.pixels[p] = std::uint8_t(std::lround(255 * std::clamp(1 - lost.pixels[p], 0.0F, 1.0F)));
  return known;
}

/// Sets the frame's light through the filter of the scene, in which `no_value` are left out.
void set_light(const Scene& scene, const PixelMask& no_value, FilteredLight& frame) {
  PointSnrImage snr = point_snr(scene);
  frame.known = known_share(no_value, scene.sigma_px);
  frame.light = PointAmplitude(snr.columns, snr.rows);
  std::vector<float> noise_e(std::size_t(snr.columns));
  for (int y = 0; y < snr.rows; ++y) {
    frame.noise_row(y, 0, snr.columns, noise_e.data());
    for (int x = 0; x < snr.columns; ++x) {
      const float known = float(frame.known.at(x, y)) / 255;
      frame.light.at(x, y) = known < min_known ? std::numeric_limits<float>::quiet_NaN()
                                               : snr.at(x, y) * noise_e[std::size_t(x)] / known;
    }
  }
  for (int y = 0; y < snr.rows; ++y)
    for (int x = 0; x < snr.columns; ++x)
      if (scene.saturated(x, y))
        forget_around(frame.light, x, y, clipped_reach_sigmas * scene.sigma_px);
}

/// Width of the PSF in the frame's middle.
double middle_sigma_px(const PsfField& psf, const CountImage& counts) {
  return psf.sigma_at({(counts.columns - 1) / 2.0, (counts.rows - 1) / 2.0});
}

}  // namespace

FilteredSequence filter_sequence(const std::vector<SequenceFrame>& frames, Threads& threads) {
  FilteredSequence out{.columns = frames[0].counts.columns,
                       .rows = frames[0].counts.rows,
                       .reference = frames.size() / 2,
                       .exposure_s = frames[0].header.exposure_s};
  std::vector<double> widths;
  for (const SequenceFrame& frame : frames) {
    Background background(frame.counts, detection_limits::background_cell_px, threads);
    const SceneParts parts(frame, background);
    const PixelMask* unusable = frame.unusable.pixels.empty() ? nullptr : &frame.unusable;
    const PsfField psf = psf_of(parts, unusable, threads);
    widths.push_back(middle_sigma_px(psf, frame.counts));
    auto stars = stars_of(parts, threads);
    out.frames.push_back({.time_s = seconds_between(frames[out.reference], frame),
                          .background = std::move(background),
                          .gain_e_per_dn = frame.header.gain_e_per_dn,
                          .psf = psf,
                          .stars = std::move(stars),
                          .light = {},
                          .known = {}});
  }
  out.sigma_px = middle_of(widths);
  const PixelMask hot = find_hot_pixels(frames, out);
  for (std::size_t i = 0; i < frames.size(); ++i) {
    PixelMask none = hot;
    for (std::size_t p = 0; p < frames[i].unusable.pixels.size(); ++p)
      none.pixels[p] |= frames[i].unusable.pixels[p];
    const SceneParts parts(frames[i], out.frames[i].background);
    Scene scene = parts.scene(&none);
    scene.sigma_px = out.sigma_px;
    set_light(scene, none, out.frames[i]);
  }
  return out;
}

}  // namespace dmise
