#include "core/camera_calibration/detector/dark_frames.h"

#include <algorithm>
#include <cmath>

#include "core/base/numeric/chi_square.h"
#include "core/camera_calibration/detector/pixel_corrections.h"
#include "core/camera_calibration/detector/pixel_series.h"

namespace dmise {
namespace {

constexpr double hot_sigmas = 6.0;  // above which no ordinary pixel is

/// Rate of a frame's ordinary pixels, with its share in the result.
struct FrameRate {
  double rate = 0.0, variance = 0.0, weight = 0.0;
};

/// Mean of values that are within `most` of a level.
double mean_near(const std::vector<float>& values, double level, double most) {
  double total = 0.0, n = 0.0;
  for (const float v : values)
    if (std::abs(double(v) - level) < most) total += double(v), ++n;
  return n > 0 ? total / n : level;
}

/// What uncoupling may leave of a hot pixel in its neighbours.
struct Neighbours {
  double left = 0.0;  // share of the hot pixel's rate
  std::size_t columns = 0;

  bool explain(const std::vector<float>& rates, std::size_t i, double level) const {
    if (!(left > 0) || i < columns || i + columns >= rates.size()) return false;
    const float most =
        std::max({rates[i - 1], rates[i + 1], rates[i - columns], rates[i + columns]});
    return double(rates[i]) - level < left * (double(most) - level);
  }
};

/// Hot pixels from those beyond a threshold T: of an exponential distribution the mean excess
/// over T is the mean of all, and the share beyond T is exp(-T / mean). Noise of the rates adds
/// sigma^2 / (2 mean^2) to the exponent. Those beyond `most` are known to be no more than that.
void measure_hot(const std::vector<float>& rates, const Neighbours& beside, double level,
                 double sigma, double most, DarkMeasurement& out) {
  const double limit = out.threshold;
  double beyond = 0.0, whole = 0.0, excess = 0.0, pixels = 0.0;
  for (std::size_t i = 0; i < rates.size(); ++i) {
    const float r = rates[i];
    if (!std::isfinite(r)) continue;
    ++pixels;
    const double over = double(r) - level - limit;
    if (!(over > 0) || beside.explain(rates, i, level)) continue;
    ++beyond;
    whole += double(r) < most;
    excess += std::min(double(r), most) - level - limit;
  }
  out.counted = std::size_t(beyond);
  out.clipped = std::size_t(beyond - whole);
  constexpr double least_counted = 5.0;
  if (whole < least_counted || !(pixels > 0)) return;
  const double mean = excess / whole, relative = 1 / std::sqrt(whole);
  const double exponent = limit / mean - 0.5 * sigma * sigma / (mean * mean);
  const double fraction = beyond / pixels * std::exp(exponent);
  if (!(fraction < 0.5)) return;  // nearly all would be hidden in the noise
  out.hot_rate = {mean, mean * relative};
  out.hot_fraction = {
      fraction, fraction * std::sqrt(1 / beyond + std::pow(limit / mean / std::sqrt(whole), 2))};
}

/// Mean excess of an ordinary pixel by hot ones below the threshold.
double hidden_mean(const DarkMeasurement& out) {
  const double h = out.hot_rate.value, limit = out.threshold;
  if (!(h > 0)) return 0.0;
  const double below = out.hot_fraction.value * (1 - std::exp(-limit / h));
  const double light = out.hot_fraction.value * (h - (limit + h) * std::exp(-limit / h));
  return light / (1 - out.hot_fraction.value + below);
}

void add_drift(const std::vector<FrameRate>& frames, double mean, DarkMeasurement& out) {
  double chi2 = 0.0, squares = 0.0, weights = 0.0, spread = 0.0;
  for (const FrameRate& f : frames) {
    const double off = f.rate - mean;
    chi2 += off * off / f.variance;
    weights += f.weight;
    squares += f.weight * f.weight;
    spread += f.weight * off * off;
  }
  const double n = double(frames.size());
  if (n < 3 || chi2 < chi_square_of_normal(3.1, n - 1)) return;
  out.drift = std::sqrt(spread / weights * n / (n - 1));
  out.current.sigma = std::hypot(out.current.sigma, out.drift * std::sqrt(squares) / weights);
}

void set_temperature(const std::vector<const CalibrationFrame*>& frames, DarkMeasurement& out) {
  double sum = 0.0, n = 0.0, low = HUGE_VAL, high = -HUGE_VAL;
  for (const CalibrationFrame* frame : frames)
    if (frame->temperature_c) {
      sum += *frame->temperature_c, ++n;
      low = std::min(low, *frame->temperature_c);
      high = std::max(high, *frame->temperature_c);
    }
  if (!(n > 0)) return;
  out.temperature_c = sum / n;
  out.temperature_spread_c = high - low;
}

}  // namespace

DarkMeasurement measure_dark(const CalibrationSet& set, const std::vector<CalibrationFrame>& frames,
                             const BiasMeasurement& bias, double saturation_dn, double coupling) {
  DarkMeasurement out;
  std::vector<const CalibrationFrame*> used;
  for (const CalibrationFrame& frame : frames)
    if (frame.exposure_s.value_or(0.0) > bias.exposure_s) used.push_back(&frame);
  out.frames = int(used.size());
  if (used.empty()) return out;
  out.longest_s = *used.back()->exposure_s;
  set_temperature(used, out);
  PixelSeries series(bias.mean.size());
  std::vector<FrameRate> of_frames;
  double weights = 0.0, bias_share = 0.0, base = 0.0;
  const double columns_variance = std::pow(bias.column_noise.value, 2) / set.columns();
  for (const CalibrationFrame* frame : used) {
    const double time_s = *frame->exposure_s - bias.exposure_s;
    auto rates = set.values(*frame);
    for (std::size_t i = 0; i < rates.size(); ++i)
      rates[i] = float((double(rates[i]) - double(bias.mean[i])) / time_s);
    const RobustLevel all = robust_level(rates);
    // Steps of whole counts hide the noise from the median of deviations.
    const double noise = std::max(frame->noise, std::sqrt(bias.floor_variance)) / time_s;
    const double sigma = std::max(all.sigma, noise);
    if (of_frames.empty()) base = all.level;
    const double mean = mean_near(rates, all.level, hot_sigmas * sigma);
    for (float& r : rates) r -= float(base);
    series.add(rates, sigma);
    const double weight = 1 / (sigma * sigma);
    of_frames.push_back(
        {mean, sigma * sigma / double(rates.size()) + columns_variance / (time_s * time_s),
         weight});
    weights += weight;
    bias_share += weight / time_s;
  }
  std::vector<float> rates(bias.mean.size());
  for (std::size_t i = 0; i < rates.size(); ++i)
    rates[i] = float(base + (used.size() > 1 ? series.at(i).mean : series.only(i)));
  uncouple(coupling, set.columns(), rates);
  const RobustLevel all = robust_level(rates);
  const double by_bias = bias_share / weights;
  const double sigma = std::max(
      all.sigma, std::sqrt(1 / weights + by_bias * by_bias * bias.floor_variance / bias.frames));
  out.threshold = hot_sigmas * sigma;
  const double most = saturation_dn > 0 ? 0.9 * saturation_dn / out.longest_s : HUGE_VAL;
  const double level = mean_near(rates, all.level, hot_sigmas * sigma);
  constexpr double uncertain_share = 0.5;  // error of the coupling, relative
  measure_hot(rates, {uncertain_share * coupling, std::size_t(set.columns())}, level, sigma, most,
              out);
  std::vector<StripSums<2>> strips(std::size_t(set.tiles().strips));
  for (std::size_t i = 0; i < rates.size(); ++i)
    if (std::abs(double(rates[i]) - level) < out.threshold) {
      auto& s = strips[set.tiles().strip_of_column(int(i % std::size_t(set.columns())))];
      s[0] += 1;
      s[1] += double(rates[i]);
    }
  out.current = jackknifed(strips, mean_of_sums);
  add_drift(of_frames, level, out);
  out.current.value -= hidden_mean(out);
  // The noise of ordinary pixels is not theirs.
  for (float& r : rates)
    if (!(double(r) - level > out.threshold)) r = float(out.current.value);
  out.rates = std::move(rates);
  return out;
}

}  // namespace dmise
