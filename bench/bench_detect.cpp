#include "bench/bench_detect.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

#include "bench/figure.h"
#include "bench/simulated_frame.h"
#include "bench/status_memory.h"
#include "bench/timing.h"
#include "core/detection/detect.h"
#include "core/detection/faint_streaks.h"

namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;

constexpr double sky_e = 1500.0, focal_px = 1663.0, declination_rad = 34 * deg;

/// A source in a frame; length 0 is a point.
struct Placed {
  double x = 0.0, y = 0.0, length = 0.0, angle = 0.0, flux_e = 0.0;
};

double noise_variance_e2(const FrameHeader& h) {
  return sky_e + h.read_noise_e * h.read_noise_e + h.gain_e_per_dn * h.gain_e_per_dn / 12;
}

double sigma_px(const FrameHeader& h) {
  const double psf = h.psf_fwhm_px / std::sqrt(8 * std::log(2.0));
  return std::sqrt(psf * psf + 1.0 / 12);
}

/// Flux of a source whose ideal matched filter has `snr`.
double flux_of_snr(const FrameHeader& h, double length, double snr) {
  const double s = sigma_px(h), q = length / (2 * s);
  const double squares = length > 0 ? (std::erf(q) - (1 - std::exp(-q * q)) / (q * std::sqrt(pi))) /
                                          (2 * s * std::sqrt(pi) * length)
                                    : 1 / (4 * pi * s * s);
  return snr * std::sqrt(noise_variance_e2(h) / squares);
}

/// The detection that has most of the SNR of those on a source; null: none.
const Detection* found(const std::vector<Detection>& all, const Placed& p) {
  const Detection* best = nullptr;
  for (const Detection& d : all) {
    const double dx = d.x_px - p.x, dy = d.y_px - p.y;
    const double along = dx * std::cos(p.angle) + dy * std::sin(p.angle);
    const double across = dy * std::cos(p.angle) - dx * std::sin(p.angle);
    if (std::abs(along) > p.length / 2 + 3 || std::abs(across) > 3 + 0.03 * p.length) continue;
    if (!best || d.snr > best->snr) best = &d;
  }
  return best;
}

/// What became of sources of one length and SNR.
struct Outcome {
  int placed = 0, found = 0;
  double squares_px2 = 0.0, bound_px2 = 0.0;  // of errors, and of the Cramer-Rao bound
  double nees = 0.0, bias_sigma = 0.0;

  double probability() const { return placed ? double(found) / placed : 0.0; }
};

/// Cramer-Rao bound of the centroid's two coordinates together: of a point, and of a long line with
/// free ends and a free slope of brightness in white noise.
double bound_px2(const FrameHeader& h, const Placed& p) {
  const double s = sigma_px(h), variance = noise_variance_e2(h);
  if (p.length <= 0) {
    const double snr2 = p.flux_e * p.flux_e / (4 * pi * s * s * variance);
    return 2 * 2 * s * s / snr2;
  }
  // By the derivatives across, by the position of each end, which is half of the middle's, and by
  // the slope, which moves the light along the line.
  const double density2 = std::pow(p.flux_e / p.length, 2) / variance;
  const double across = 4 * s * s * s * std::sqrt(pi) / (density2 * p.length);
  const double end = 4 * pi * s * s / density2;
  const double snr2 = density2 * p.length / (2 * s * std::sqrt(pi));
  return across + end / 2 + p.length * p.length / (12 * snr2);
}

Outcome trial(double length, double snr, int frames, unsigned seed) {
  constexpr int size = 1500;
  const int side = length > 600 ? 1 : length > 250 ? 3 : 6;
  const double exposure_s = length > 0 ? 1e-3 : 20.0;  // stars must trail to tell points from them
  Threads threads(2);
  Outcome out;
  for (int f = 0; f < frames; ++f) {
    const FrameHeader header =
        camera_header(size, size, focal_px, declination_rad, exposure_s, true);
    SimulatedFrame frame(header, size, size, sky_e, seed + unsigned(f));
    std::vector<Placed> sources;
    for (int i = 0; i < side * side; ++i) {
      const double cell = double(size) / side;
      const Placed p{(i % side + 0.5) * cell + frame.uniform(-5, 5),
                     (i / side + 0.5) * cell + frame.uniform(-5, 5), length, frame.uniform(0, pi),
                     flux_of_snr(header, length, snr)};
      if (length > 0)
        frame.add_streak(p.x, p.y, length, p.angle, p.flux_e);
      else
        frame.add_point(p.x, p.y, p.flux_e);
      sources.push_back(p);
    }
    const auto result = detect(frame.expose(), header, {}, threads);
    for (const Placed& p : sources) {
      ++out.placed;
      const Detection* d = found(result.detections, p);
      if (!d) continue;
      ++out.found;
      const double dx = d->x_px - p.x, dy = d->y_px - p.y;
      const auto [xx, xy, yy] = d->covariance_px2;
      out.squares_px2 += dx * dx + dy * dy;
      out.bound_px2 += bound_px2(header, p);
      out.nees += (dx * dx * yy - 2 * dx * dy * xy + dy * dy * xx) / (xx * yy - xy * xy) / 2;
      out.bias_sigma += (d->signal_e - p.flux_e) / (d->signal_e / d->snr);
    }
  }
  return out;
}

/// SNR at which half are found, between trials half an SNR apart, two from `from` + 6 on; infinite
/// if it is more than 30.
double half_found_snr(double length, double from, int frames) {
  double before = 0.0;
  for (double snr = from, step = 0.5; snr < 30; snr += step) {
    step = snr < from + 6 ? 0.5 : 2.0;
    const double now = trial(length, snr, frames, 1000).probability();
    if (now >= 0.5) return snr - step * (now - 0.5) / std::max(now - before, 1e-9);
    before = now;
  }
  return HUGE_VAL;
}

}  // namespace

int bench_detect(bool json) {
  constexpr int columns = 3326, rows = 2504, stars = 18000;
  const FrameHeader header = camera_header(columns, rows, focal_px, declination_rad, 20, true);
  double seconds = 0.0, peak_mb = 0.0, alarms = 0.0;
  constexpr int star_frames = 4;
  for (int f = 0; f < star_frames; ++f) {
    SimulatedFrame frame(header, columns, rows, sky_e, 50u + unsigned(f));
    frame.add_stars(stars, 300, 2e6);
    const CountImage counts = frame.expose();
    Threads one;
    const double before = status_mb("VmRSS");
    std::ofstream("/proc/self/clear_refs") << "5";  // proc(5): resets the peak
    const double start = thread_seconds();
    alarms += double(detect(counts, header, {}, one).detections.size());
    seconds += thread_seconds() - start;
    peak_mb = std::max(peak_mb, status_mb("VmHWM") - before);
  }
  print_figure({"frame_s", seconds / star_frames, "s", "", 0, 0.35, true}, json);
  print_figure({"frame_peak_mb", peak_mb, "MB", "", 0, 70, true}, json);
  print_figure({"false_alarms_per_frame", alarms / star_frames, "1", "", 0, 0.1, true}, json);

  print_figure({"pd_shift_points_snr", half_found_snr(0, 4.0, 3) - DetectorSettings().least_snr,
                "SNR", "", 0, 0.3, true},
               json);
  double worst = -1e9;
  for (const double length : {5.0, 20.0, 100.0, 300.0, 1000.0}) {
    const double threshold = least_streak_snr(length);
    const double shift = half_found_snr(length, threshold - 1.5, length > 600 ? 24 : 4) - threshold;
    worst = std::max(worst, shift);
    print_figure(
        {"pd_shift_streak_" + std::to_string(int(length)) + "_snr", shift, "SNR", "", 0, 0.3, true},
        json);
  }
  print_figure({"pd_shift_streaks_snr", worst, "SNR", "", 0, 0.3, true}, json);

  const Outcome points = trial(0, 20, 8, 3000), streaks = trial(100, 40, 8, 4000);
  for (const auto& [name, o] : {std::pair{"points", &points}, std::pair{"streaks", &streaks}}) {
    const std::string of = name;
    const double n = std::max(o->found, 1);
    print_figure({"position_over_crlb_" + of, std::sqrt(o->squares_px2 / o->bound_px2), "1", "", 0,
                  1.15, true},
                 json);
    print_figure({"nees_" + of, o->nees / n, "1", "", 0, 1.05, true}, json);
    print_figure({"magnitude_bias_sigma_" + of, std::abs(o->bias_sigma / n), "1", "", 0, 0.2, true},
                 json);
  }
  return 0;
}

}  // namespace dmise
