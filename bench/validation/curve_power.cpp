#include "bench/validation/curve_power.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <limits>

#include "core/base/formatted.h"
#include "core/base/numeric/quantile.h"
#include "core/base/numeric/rng.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr double step_s = 0.1, widest_gap_s = 1.05, min_length_s = 16.0;
constexpr double fastest_hz = 0.5, white_above_hz = 1.0;
constexpr std::array<double, 6> edges_s{2, 4, 8, 16, 32, 64};
constexpr double part_of_band = 1.2;  // shortest periods of a band that a track must last

/// Power density of a series of even steps about its straight line, tapered by Hann's window.
struct Periodogram {
  double spacing_hz = 0.0;
  std::vector<double> density;  // mag2 / Hz, at multiples of the spacing from 1
  double at_hz(std::size_t k) const { return double(k + 1) * spacing_hz; }
};

std::vector<double> about_line(const std::vector<double>& y) {
  const double middle = (double(y.size()) - 1.0) / 2.0;
  double mean = 0.0, slope = 0.0, square = 0.0;
  for (const double v : y) mean += v / double(y.size());
  for (std::size_t i = 0; i < y.size(); ++i) {
    const double x = double(i) - middle;
    slope += x * y[i];
    square += x * x;
  }
  slope /= square;
  std::vector<double> rest;
  for (std::size_t i = 0; i < y.size(); ++i)
    rest.push_back(y[i] - mean - slope * (double(i) - middle));
  return rest;
}

Periodogram periodogram(const std::vector<double>& y, double up_to_hz) {
  const std::size_t n = y.size();
  std::vector<double> tapered = about_line(y);
  double weight = 0.0;
  for (std::size_t i = 0; i < n; ++i) {
    const double w = 0.5 - 0.5 * std::cos(2.0 * pi * double(i + 1) / double(n + 1));
    tapered[i] *= w;
    weight += w * w;
  }
  Periodogram p{.spacing_hz = 1.0 / (double(n) * step_s)};
  for (std::size_t k = 1; k < n / 2 && double(k) * p.spacing_hz <= up_to_hz; ++k) {
    const auto turn = std::polar(1.0, -2.0 * pi * double(k) / double(n));
    std::complex<double> sum = 0.0, phase = 1.0;
    for (const double v : tapered) {
      sum += v * phase;
      phase *= turn;
    }
    p.density.push_back(2.0 * step_s * std::norm(sum) / weight);
  }
  return p;
}

/// Mean density over [least, most) less the white level; nothing without a frequency there.
double mean_density(const Periodogram& p, double min_hz, double max_hz, double white) {
  double sum = 0.0;
  int count = 0;
  for (std::size_t k = 0; k < p.density.size(); ++k)
    if (p.at_hz(k) >= min_hz && p.at_hz(k) < max_hz) {
      sum += p.density[k] - white;
      ++count;
    }
  return count ? sum / count : std::numeric_limits<double>::quiet_NaN();
}

/// The longest run of a curve in even steps.
struct SteadyRun {
  std::vector<double> time_s;  // when the steps are
  double seconds() const { return double(time_s.size()) * step_s; }
};

SteadyRun longest_run(const std::vector<double>& time_s) {
  std::size_t best_begin = 0, best_end = 0, begin = 0;
  for (std::size_t i = 1; i <= time_s.size(); ++i) {
    if (i < time_s.size() && time_s[i] - time_s[i - 1] <= widest_gap_s) continue;
    if (best_end == best_begin ||
        time_s[i - 1] - time_s[begin] > time_s[best_end - 1] - time_s[best_begin]) {
      best_begin = begin;
      best_end = i;
    }
    begin = i;
  }
  SteadyRun run;
  if (best_end > best_begin)
    for (double t = time_s[best_begin]; t < time_s[best_end - 1]; t += step_s)
      run.time_s.push_back(t);
  return run;
}

/// Values between those at `time_s`, which ascend, along straight lines.
std::vector<double> at_steps(const SteadyRun& run, const std::vector<double>& time_s,
                             const std::vector<double>& values) {
  std::vector<double> out;
  std::size_t i = 0;
  for (const double t : run.time_s) {
    while (i + 2 < time_s.size() && time_s[i + 1] < t) ++i;
    const double wide = time_s[i + 1] - time_s[i];
    const double part = wide > 0.0 ? std::clamp((t - time_s[i]) / wide, 0.0, 1.0) : 0.0;
    out.push_back(values[i] + part * (values[i + 1] - values[i]));
  }
  return out;
}

/// Powers of one curve by band, the last of all; not a number where the track is too short.
std::vector<double> band_powers(const Periodogram& p, double white, double seconds) {
  std::vector<double> powers;
  const double slowest_hz = 0.999 / seconds;
  for (std::size_t b = 0; b + 1 < edges_s.size(); ++b) {
    const double min_hz = 1.0 / edges_s[b + 1], max_hz = 1.0 / edges_s[b];
    powers.push_back(seconds < part_of_band * edges_s[b]
                         ? std::numeric_limits<double>::quiet_NaN()
                         : (max_hz - min_hz) *
                               mean_density(p, std::max(min_hz, slowest_hz), max_hz, white));
  }
  double all = 0.0;
  for (std::size_t k = 0; k < p.density.size(); ++k)
    if (p.at_hz(k) < fastest_hz) all += (p.density[k] - white) * p.spacing_hz;
  powers.push_back(all);
  return powers;
}

/// Half octaves of periods from 2 s, for the picture.
std::vector<double> half_octaves_s() {
  std::vector<double> edges;
  for (double edge = edges_s.front(); edge < 1.01 * edges_s.back(); edge *= std::sqrt(2.0))
    edges.push_back(edge);
  return edges;
}

std::vector<double> densities_of(const Periodogram& p, double white, double seconds) {
  std::vector<double> all;
  const auto edges = half_octaves_s();
  for (std::size_t i = 0; i + 1 < edges.size(); ++i)
    all.push_back(
        mean_density(p, std::max(1.0 / edges[i + 1], 0.999 / seconds), 1.0 / edges[i], white));
  return all;
}

/// Numbers of many curves, by column.
class Columns {
 public:
  void add(const std::vector<double>& row) {
    columns_.resize(std::max(columns_.size(), row.size()));
    for (std::size_t i = 0; i < row.size(); ++i)
      if (std::isfinite(row[i])) columns_[i].push_back(row[i]);
  }
  std::size_t count(std::size_t i) const { return i < columns_.size() ? columns_[i].size() : 0; }
  double mean(std::size_t i) const {
    double sum = 0.0;
    for (std::size_t k = 0; k < count(i); ++k) sum += columns_[i][k];
    return count(i) ? sum / double(count(i)) : 0.0;
  }
  double median(std::size_t i) const { return count(i) ? median_of(columns_[i]) : 0.0; }

 private:
  std::vector<std::vector<double>> columns_;
};

}  // namespace

CurvePower curve_power(std::span<const PassLightCurve> curves) {
  Columns measured, model, measured_density, model_density, smooth_density;
  std::vector<double> whites;
  for (std::size_t c = 0; c < curves.size(); ++c) {
    const PassLightCurve& curve = curves[c];
    const SteadyRun run = longest_run(curve.time_s);
    if (run.seconds() < min_length_s) continue;
    const Periodogram p = periodogram(at_steps(run, curve.time_s, curve.measured_mag), 1e9);
    const double white = mean_density(p, white_above_hz, 1e9, 0.0);
    whites.push_back(std::sqrt(white / (2.0 * step_s)));
    measured.add(band_powers(p, white, run.seconds()));
    measured_density.add(densities_of(p, white, run.seconds()));
    const std::vector<double> smooth = at_steps(run, curve.time_s, curve.smooth_mag);
    smooth_density.add(densities_of(periodogram(smooth, fastest_hz), 0.0, run.seconds()));
    std::vector<float> noise(smooth.size());
    for (std::uint64_t seed = 1; seed <= glint_seeds; ++seed) {
      std::vector<double> mag = at_steps(run, curve.time_s, curve.glints_mag(seed));
      rng_normals(rng_key(seed, "light curve", std::uint32_t(c), "noise"), 0, 0, noise);
      for (std::size_t i = 0; i < mag.size(); ++i) mag[i] += smooth[i] + whites.back() * noise[i];
      const Periodogram of_model = periodogram(mag, fastest_hz);
      model.add(band_powers(of_model, white, run.seconds()));
      model_density.add(densities_of(of_model, white, run.seconds()));
    }
  }
  CurvePower power;
  if (whites.empty()) return power;
  power.white_mag = median_of(whites);
  for (std::size_t b = 0; b < edges_s.size(); ++b) {
    const bool all = b + 1 == edges_s.size();
    power.bands.push_back({.shortest_s = all ? edges_s.front() : edges_s[b],
                           .longest_s = all ? 0.0 : edges_s[b + 1],
                           .tracks = measured.count(b),
                           .measured_mean = measured.mean(b),
                           .measured_median = measured.median(b),
                           .model_mean = model.mean(b),
                           .model_median = model.median(b)});
  }
  const auto edges = half_octaves_s();
  for (std::size_t i = 0; i + 1 < edges.size(); ++i)
    if (measured_density.count(i) > 0)
      power.densities.push_back({std::sqrt(edges[i] * edges[i + 1]), measured_density.mean(i),
                                 model_density.mean(i), smooth_density.mean(i)});
  return power;
}

Chart power_chart(const CurvePower& power, const std::string& title) {
  constexpr double least = 1e-6, most = 10.0;
  Chart chart{.title = title,
              .subtitle =
                  "held-out half, mean over tracks of the power of their light curves; "
                  "white noise is subtracted"};
  const auto add = [&](const char* label, Colour colour, double CurvePower::Density::*value) {
    ChartSeries series{.label = label, .colour = colour, .lines = {{}}};
    for (const auto& d : power.densities)
      series.lines[0].push_back({d.period_s, std::clamp(d.*value, least, most)});
    chart.series.push_back(std::move(series));
  };
  add("measured", {120, 120, 120}, &CurvePower::Density::measured);
  add("model", {31, 119, 180}, &CurvePower::Density::model);
  add("model without glints", {255, 127, 14}, &CurvePower::Density::smooth);
  chart.x = {.label = "period, s",
             .least = edges_s.front(),
             .most = edges_s.back(),
             .logarithmic = true,
             .ticks = {}};
  for (const double edge : edges_s) chart.x.ticks.push_back({edge, formatted("%g", edge)});
  chart.y = {
      .label = "power, mag2/Hz", .least = least, .most = most, .logarithmic = true, .ticks = {}};
  for (double at = least; at < 1.5 * most; at *= 10.0)
    chart.y.ticks.push_back({at, formatted("%g", at)});
  return chart;
}

}  // namespace dmise
