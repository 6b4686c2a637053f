#include "core/sequences/sky_motion.h"

#include <algorithm>
#include <cmath>

#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double max_trail_widths = 2.0, min_way_widths = 2.0;
constexpr double max_scatter = 0.1;  // from an even motion, over its length

/// How the middle of the detector moves over the sky; 0 where it rests or was moved by hand.
PixelPosition detector_rate(const FilteredSequence& sequence, const Registration& registration) {
  const PixelPosition middle{(sequence.columns - 1) / 2.0, (sequence.rows - 1) / 2.0};
  std::vector<PixelPosition> places;
  double mean_s = 0.0, square_s2 = 0.0;
  PixelPosition mean, rate;
  const auto n = double(sequence.frames.size());
  for (std::size_t i = 0; i < sequence.frames.size(); ++i) {
    places.push_back(registration.in_reference(i, middle));
    mean = mean + places.back() * (1 / n);
    mean_s += sequence.frames[i].time_s / n;
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const double dt = sequence.frames[i].time_s - mean_s;
    rate = rate + (places[i] - mean) * dt;
    square_s2 += dt * dt;
  }
  rate = rate * (1 / square_s2);
  double off_px = 0.0;
  for (std::size_t i = 0; i < places.size(); ++i) {
    const PixelPosition off = places[i] - mean - rate * (sequence.frames[i].time_s - mean_s);
    off_px = std::max(off_px, std::hypot(off.x_px, off.y_px));
  }
  const double way_px = std::hypot(rate.x_px, rate.y_px) * sequence.span_s();
  return off_px < max_scatter * way_px ? rate : PixelPosition{};
}

}  // namespace

bool MotionRange::has(PixelPosition rate) const {
  const PixelPosition off = rate - middle;
  return std::hypot(off.x_px, off.y_px) <= max_px_per_s &&
         std::hypot(rate.x_px, rate.y_px) >= min_px_per_s;
}

double MotionRange::acceleration_px_per_s2(PixelPosition rate) const {
  return (rate.x_px * rate.x_px + rate.y_px * rate.y_px) * scale_rad_per_px;
}

MotionRange motion_range(const FilteredSequence& sequence, const Registration& registration,
                         double scale_rad_per_px, double max_px_per_s) {
  const double fwhm_px = fwhm_per_sigma * sequence.sigma_px;
  if (!(max_px_per_s > 0)) max_px_per_s = max_trail_widths * fwhm_px / sequence.exposure_s;
  return {.middle = detector_rate(sequence, registration),
          .max_px_per_s = max_px_per_s,
          .min_px_per_s = min_way_widths * fwhm_px / sequence.span_s(),
          .scale_rad_per_px = scale_rad_per_px};
}

}  // namespace dmise
