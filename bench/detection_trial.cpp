#include "bench/detection_trial.h"

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "core/base/algebra/symmetric2.h"
#include "core/detection/detect.h"

namespace dmise {
namespace {

using simulated::camera_header;
using simulated::SimulatedFrame;

constexpr double sky_e = 1500.0, focal_px = 1663.0;
constexpr double faintest_star_snr = 1.0;
constexpr double place_error_px = 0.1, light_error = 0.1;  // errors of the catalogue in a frame
constexpr double star_free_noise = 0.3;  // stars' light in a pixel's noise up to which it is theirs

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
const Detection* found(const std::vector<Detection>& all, const PlacedSource& p) {
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

/// Cramer-Rao bound of a point's coordinates together, with the noise of its own light: of each
/// 1 / integral of (dS / dx)^2 / (variance + S), where the derivative's square is half of the
/// radial one's in the mean over directions.
double bound_of_point_px2(double flux_e, double sigma_px, double variance_e2) {
  constexpr int steps = 200;
  constexpr double reach = 6.0;  // deviations
  const double step_px = reach * sigma_px / steps;
  double information = 0.0;
  for (int i = 0; i < steps; ++i) {
    const double r_px = (i + 0.5) * step_px, r2 = r_px * r_px / (sigma_px * sigma_px);
    const double signal_e = flux_e * std::exp(-0.5 * r2) / (2 * pi * sigma_px * sigma_px);
    const double slope = signal_e * r_px / (sigma_px * sigma_px);
    information += pi * r_px * step_px * slope * slope / (variance_e2 + signal_e);
  }
  return 2.0 / information;
}

/// Cramer-Rao bound of the centroid's two coordinates together: of a point, and of a long line with
/// free ends and a free slope of brightness in white noise.
double bound_px2(const FrameHeader& h, const PlacedSource& p) {
  const double s = sigma_px(h), variance = noise_variance_e2(h);
  if (p.length <= 0) return bound_of_point_px2(p.flux_e, s, variance);
  // By the derivatives across, by the position of each end, which is half of the middle's, and by
  // the slope, which moves the light along the line.
  const double density2 = std::pow(p.flux_e / p.length, 2) / variance;
  const double across = 4 * s * s * s * std::sqrt(pi) / (density2 * p.length);
  const double end = 4 * pi * s * s / density2;
  const double snr2 = density2 * p.length / (2 * s * std::sqrt(pi));
  return across + end / 2 + p.length * p.length / (12 * snr2);
}

/// Share of a source's SNR^2 in pixels without light of stars.
double free_share(const FrameHeader& h, const ExpectedElectronImage& electrons,
                  const PlacedSource& p) {
  const double s = sigma_px(h);
  const double limit_e = sky_e + star_free_noise * std::sqrt(noise_variance_e2(h));
  const int reach = int(std::ceil(2 * s));
  const int steps = std::max(1, int(std::ceil(p.length)));
  double sum = 0.0, free = 0.0;
  for (int k = 0; k < steps; ++k) {
    const double along = ((k + 0.5) / steps - 0.5) * p.length;
    const int x = int(std::lround(p.x + along * std::cos(p.angle)));
    const int y = int(std::lround(p.y + along * std::sin(p.angle)));
    for (int j = -reach; j <= reach; ++j)
      for (int i = -reach; i <= reach; ++i) {
        if (x + i < 0 || y + j < 0 || x + i >= electrons.columns || y + j >= electrons.rows)
          continue;
        const double weight = std::exp(-(i * i + j * j) / (s * s));
        sum += weight;
        free += electrons.at(x + i, y + j) < limit_e ? weight : 0.0;
      }
  }
  return sum > 0 ? free / sum : 0.0;
}

double q_function(double x) { return 0.5 * std::erfc(x / std::sqrt(2.0)); }

std::vector<PlacedSource> placed(SimulatedFrame& frame, const FrameHeader& header, int size,
                                 double length, double snr) {
  const double flux_e = flux_of_snr(header, length, snr);
  std::vector<PlacedSource> out;
  if (length > 600) {  // three beside each other
    const double angle = frame.uniform(0, pi);
    for (const double off : {-350.0, 0.0, 350.0})
      out.push_back({0.5 * size - off * std::sin(angle) + frame.uniform(-5, 5),
                     0.5 * size + off * std::cos(angle) + frame.uniform(-5, 5), length, angle,
                     flux_e});
    return out;
  }
  const int side = length > 250 ? 4 : 8;
  for (int i = 0; i < side * side; ++i) {
    const double cell = double(size) / side;
    out.push_back({(i % side + 0.5) * cell + frame.uniform(-5, 5),
                   (i / side + 0.5) * cell + frame.uniform(-5, 5), length, frame.uniform(0, pi),
                   flux_e});
  }
  return out;
}

/// `share`: of the source's SNR^2 that stars do not hide; no more can place it.
void add_result(const FrameHeader& header, const PlacedSource& p, double share, const Detection* d,
                DetectionOutcome& out) {
  if (!d) return;
  ++out.found;
  const double dx = d->x_px - p.x, dy = d->y_px - p.y;
  out.squares_px2 += dx * dx + dy * dy;
  out.bound_px2 += bound_px2(header, p) / std::max(share, 0.1);
  out.nees += mahalanobis2(d->covariance_px2, dx, dy) / 2;
  out.bias_sigma += (d->signal_e - p.flux_e) / (d->signal_e / d->snr);
}

}  // namespace

void DetectionOutcome::add(const DetectionOutcome& other) {
  placed += other.placed, found += other.found, in_theory += other.in_theory;
  squares_px2 += other.squares_px2, bound_px2 += other.bound_px2;
  nees += other.nees, bias_sigma += other.bias_sigma;
}

FrameHeader trial_header(int columns, int rows, double exposure_s, const StarField& field,
                         double deeper_mag) {
  FrameHeader header =
      camera_header(columns, rows, focal_px, field.dec_rad, exposure_s, true, field.ra_rad);
  if (field.sky)
    header.zero_point_mag = field.sky->complete_to_v_mag() + deeper_mag +
                            2.5 * std::log10(flux_of_snr(header, 0, 5.0) / exposure_s);
  return header;
}

SimulatedFrame trial_frame(const FrameHeader& header, int columns, int rows, const StarField& field,
                           unsigned seed) {
  SimulatedFrame frame(header, columns, rows, sky_e, seed);
  std::normal_distribution<double> normal;
  if (field.sky)
    for (const ExpectedStar& star :
         field.sky->stars_in(header, columns, rows, flux_of_snr(header, 0, faintest_star_snr)))
      frame.add_star(star.place.x_px + place_error_px * normal(frame.random()),
                     star.place.y_px + place_error_px * normal(frame.random()),
                     star.signal_e * std::exp(light_error * normal(frame.random())));
  return frame;
}

DetectionOutcome detection_trial(double length, double snr, double threshold, int frames,
                                 const StarField& field, unsigned seed) {
  constexpr int size = 1500;
  // Without a catalogue stars must trail to tell points from them.
  const double exposure_s = length > 0 ? 1e-3 : 20.0;
  const FrameHeader header = trial_header(size, size, exposure_s, field);
  Threads threads(2);
  DetectionOutcome out;
  for (int f = 0; f < frames; ++f) {
    SimulatedFrame frame = trial_frame(header, size, size, field, seed + unsigned(f));
    const auto sources = placed(frame, header, size, length, snr);
    std::vector<double> shares;
    for (const PlacedSource& p : sources) {
      ++out.placed;
      shares.push_back(free_share(header, frame.electrons(), p));
      const double seen = snr * std::sqrt(shares.back());
      out.in_theory += q_function(threshold - seen);
    }
    for (const PlacedSource& p : sources) {
      if (length > 0)
        frame.add_streak(p.x, p.y, length, p.angle, p.flux_e);
      else
        frame.add_point(p.x, p.y, p.flux_e);
    }
    const auto result = detect(frame.expose(), header, {}, threads, field.sky);
    for (std::size_t i = 0; i < sources.size(); ++i)
      add_result(header, sources[i], shares[i], found(result.detections, sources[i]), out);
  }
  return out;
}

double late_by_snr(double length, double threshold, int frames, const StarField& field,
                   unsigned seed) {
  constexpr double step = 0.5, most = 8.0;
  const auto crossing = [](double snr, double now, double before) {
    return snr - step * (now - 0.5) / std::max(now - before, 1e-9);
  };
  double measured = HUGE_VAL, in_theory = HUGE_VAL, now = 0.0, theory = 0.0;
  for (double snr = threshold - 1; snr < threshold + most; snr += step) {
    const DetectionOutcome o = detection_trial(length, snr, threshold, frames, field, seed);
    const double p = o.probability(), q = o.probability_in_theory();
    if (p >= 0.5 && measured == HUGE_VAL) measured = crossing(snr, p, now);
    if (q >= 0.5 && in_theory == HUGE_VAL) in_theory = crossing(snr, q, theory);
    if (measured < HUGE_VAL && in_theory < HUGE_VAL) return measured - in_theory;
    now = p;
    theory = q;
  }
  return most;
}

}  // namespace dmise
