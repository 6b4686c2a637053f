#include "core/detection/curve/light_period.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/base/numeric/golden_section.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr std::size_t max_harmonics = 16;
constexpr double shortest_fwhms = 1.75;  // shortest period of a harmonic: the PSF leaves 0.3 of it
constexpr double max_cycles = 160.0;     // on the line, of the highest harmonic: bounds the time
constexpr double steps = 4.0;            // frequency steps for a cycle more of the highest harmonic
constexpr double worth_more = 6.0;       // gain in chi2 by which a period must beat a bend
constexpr double least_for_longer =
    15.0;  // gain in score that a multiple of a period needs: it has more harmonics
constexpr double min_share_for_longer = 0.02;  // and so much of it more
constexpr int phases = 720;                    // places in a period at which its light is looked at

/// Light along the line, in units in which the fit is linear, and its products with all others.
struct Column {
  std::vector<double> shape;    // by pieces
  double background = 0.0;      // and an even background
  std::vector<double> product;  // the equations' matrix times this column
  double background_product = 0.0, right = 0.0;
};

Column column_of(const StreakLight& light, std::vector<double> shape, double background = 0.0) {
  Column out{.shape = {}, .background = background, .product = light.matrix.times(shape)};
  out.background_product = background * light.background_weight;
  out.right = background * light.background_right;
  for (std::size_t i = 0; i < shape.size(); ++i) {
    out.product[i] += background * light.background[i];
    out.background_product += light.background[i] * shape[i];
    out.right += light.right[i] * shape[i];
  }
  out.shape = std::move(shape);
  return out;
}

double product_of(const Column& a, const Column& b) {
  double sum = a.background * b.background_product;
  for (std::size_t i = 0; i < a.shape.size(); ++i) sum += a.shape[i] * b.product[i];
  return sum;
}

/// Pieces at either end whose light is free: those beyond it, and as many within as its error may
/// leave without light.
constexpr std::size_t free_pieces = pieces_beyond + 2;

/// The column of a function of the place along the line, 0 at the ends.
template <class Function>
Column along_line(const StreakLight& light, const Function& of) {
  std::vector<double> shape(light.all_pieces(), 0.0);
  for (std::size_t i = free_pieces; i + free_pieces < shape.size(); ++i)
    shape[i] = of(light.along_px(i));
  return column_of(light, std::move(shape));
}

Column free_piece(const StreakLight& light, std::size_t piece) {
  std::vector<double> shape(light.all_pieces(), 0.0);
  shape[piece] = 1.0;
  return column_of(light, std::move(shape));
}

/// What is fitted beside the period: both ends, the background, even light and its slope.
constexpr std::size_t others = 2 * free_pieces + 3, even_light = others - 2;

std::vector<Column> other_columns(const StreakLight& light) {
  std::vector<Column> out;
  for (std::size_t i = 0; i < free_pieces; ++i) {
    out.push_back(free_piece(light, i));
    out.push_back(free_piece(light, light.all_pieces() - 1 - i));
  }
  out.push_back(column_of(light, std::vector<double>(light.all_pieces(), 0.0), 1.0));
  out.push_back(along_line(light, [](double) { return 1.0; }));
  out.push_back(along_line(light, [&](double px) { return 2 * px / light.length_px; }));
  return out;
}

BandedMatrix products_of(std::span<const Column> columns) {
  BandedMatrix out(columns.size(), columns.size());
  for (std::size_t i = 0; i < columns.size(); ++i)
    for (std::size_t j = 0; j <= i; ++j) out.at(i, j) = product_of(columns[i], columns[j]);
  return out;
}

/// By how much chi2 is less with the first columns than without any, for each number of columns.
std::vector<double> gains_of(std::span<const Column> columns) {
  BandedMatrix factor = products_of(columns);
  if (!factor.factorise()) return {};
  std::vector<double> gains{0.0}, z;
  for (std::size_t i = 0; i < columns.size(); ++i) {
    double value = columns[i].right;
    for (std::size_t j = 0; j < i; ++j) value -= factor.at(i, j) * z[j];
    z.push_back(value / factor.at(i, i));
    gains.push_back(gains.back() + z.back() * z.back());
  }
  return gains;
}

/// Harmonics 1 to `count` of a frequency [1/px], each as steps from piece to piece that have its
/// amplitude: that of steps through it is less by a sinc.
void add_harmonics(const StreakLight& light, double frequency, std::size_t count,
                   std::vector<Column>& columns) {
  for (std::size_t h = 1; h <= count; ++h) {
    const double turn = 2 * pi * frequency * double(h), half = turn * light.piece_px / 2;
    const double height = half / std::sin(half);
    columns.push_back(along_line(light, [&](double px) { return height * std::cos(turn * px); }));
    columns.push_back(along_line(light, [&](double px) { return height * std::sin(turn * px); }));
  }
}

double highest_frequency(const StreakLight& light) {
  return std::min(1 / (shortest_fwhms * light.fwhm_px), max_cycles / light.length_px);
}

std::size_t harmonics_at(const StreakLight& light, double frequency) {
  return std::min(max_harmonics, std::size_t(highest_frequency(light) / frequency));
}

/// A frequency, its harmonics and how good they are.
struct PeriodCandidate {
  double frequency = 0.0, gain = 0.0, score = -HUGE_VAL;
  std::size_t harmonics = 0;
};

class Periodogram {
 public:
  explicit Periodogram(const StreakLight& light)
      : light_(light),
        others_(other_columns(light)),
        bins_(double(light.pieces) / double(pieces_of_bin)) {}

  double frequency_step(double frequency) const {
    const auto most = double(std::max<std::size_t>(harmonics_at(light_, frequency), 1));
    return 1 / (steps * most * light_.length_px);
  }
  /// What each parameter must gain, by the Bayesian information criterion.
  double price() const { return std::log(bins_); }

  /// The best number of harmonics of a frequency.
  PeriodCandidate at(double frequency) const {
    PeriodCandidate best;
    const std::vector<double> gains = gains_at(frequency, harmonics_at(light_, frequency));
    for (std::size_t h = 1; others + 2 * h < gains.size(); ++h) {
      const double gain = gains[others + 2 * h];
      const double score = gain - 2 * double(h) * price();
      if (score > best.score) best = {frequency, gain, score, h};
    }
    return best;
  }

  PeriodCandidate best() const {
    constexpr double min_share = 0.85;  // light that repeats has this share of free light's gain
    PeriodCandidate out = highest(1 / light_.length_px);
    // Less than two periods are free light: what repeats explains nearly as much.
    if (const double two = 2 / light_.length_px; out.frequency < two) {
      const PeriodCandidate repeated = highest(two);
      if (repeated.gain > min_share * out.gain) out = repeated;
    }
    // A multiple of the frequency explains it as well where harmonics between have only noise.
    for (std::size_t m = 6; m >= 2; --m) {
      if (out.harmonics < m) continue;
      const PeriodCandidate shorter =
          refined(out.frequency * double(m), out.harmonics / m, 1 / light_.length_px);
      if (shorter.score > out.score - least_for_longer - min_share_for_longer * out.score)
        return shorter;
    }
    return out;
  }

  /// The best score from a frequency on.
  PeriodCandidate highest(double first) const {
    PeriodCandidate out;
    const double last = highest_frequency(light_);
    for (double f = first; f <= last; f += frequency_step(f))
      if (const PeriodCandidate one = at(f); one.score > out.score) out = one;
    if (out.harmonics == 0) return out;
    return refined(out.frequency, out.harmonics, frequency_step(out.frequency));
  }

  /// The best frequency within a step of one.
  PeriodCandidate refined(double frequency, std::size_t harmonics, double step) const {
    step = std::min(step, 1 / (steps * double(harmonics) * light_.length_px));
    const Least least = golden_section([&](double f) { return -gain_at(f, harmonics); },
                                       frequency - step, frequency + step, 1e-4 * step);
    return {least.at, -least.value, -least.value - 2 * double(harmonics) * price(), harmonics};
  }

  /// Gain by a number of harmonics over the other columns alone, in units of the noise.
  double gain_at(double frequency, std::size_t harmonics) const {
    const std::vector<double> gains = gains_at(frequency, harmonics);
    return gains.empty() ? 0.0 : gains.back();
  }

  /// The standard deviation of a frequency, by the curvature of chi2; infinite if it has none.
  double sigma_of(const PeriodCandidate& c) const {
    const double step = 0.1 * frequency_step(c.frequency);
    const double bend = (gain_at(c.frequency + step, c.harmonics) - 2 * c.gain +
                         gain_at(c.frequency - step, c.harmonics)) /
                        (step * step);
    return bend < 0 ? std::sqrt(-2 / bend) : HUGE_VAL;
  }

  /// Whether the light repeats rather than bends once: by parabola and cubic.
  bool beats_bend(const PeriodCandidate& c) const {
    std::vector<Column> columns = others_;
    for (const double power : {2.0, 3.0})
      columns.push_back(along_line(
          light_, [&](double px) { return std::pow(2 * px / light_.length_px, power); }));
    const std::vector<double> gains = gains_of(columns);
    if (gains.empty()) return true;
    const double bend = (gains.back() - gains[others]) / light_.misfit() - 2 * price();
    return c.score - price() > bend + worth_more;
  }

  /// Probability that noise has a score as high, at any frequency and number of harmonics.
  double false_alarm(const PeriodCandidate& c) const;

  /// Coefficients of all columns and their covariance.
  struct Solution {
    std::vector<double> value;
    BandedMatrix factor;
  };
  std::optional<Solution> solution(const PeriodCandidate& c) const {
    std::vector<Column> columns = others_;
    add_harmonics(light_, c.frequency, c.harmonics, columns);
    Solution out{.value = {}, .factor = products_of(columns)};
    if (!out.factor.factorise()) return std::nullopt;
    std::vector<double> right;
    for (const Column& column : columns) right.push_back(column.right);
    out.value = out.factor.solve(std::move(right));
    return out;
  }

 private:
  /// By the number of columns; those of the others alone are 0.
  std::vector<double> gains_at(double frequency, std::size_t harmonics) const {
    std::vector<Column> columns = others_;
    add_harmonics(light_, frequency, harmonics, columns);
    std::vector<double> gains = gains_of(columns);
    if (gains.empty()) return gains;
    const double without = gains[others];
    for (double& gain : gains) gain = (gain - without) / light_.misfit();
    return gains;
  }

  const StreakLight& light_;
  std::vector<Column> others_;
  double bins_;
};

/// Logarithm of the factor of Baluev's approximation for n harmonics.
double log_factor(std::size_t n) {
  double sum = 0.0, log_odd = 0.0;
  for (std::size_t k = 1; k <= n; ++k) {
    log_odd += std::log(2.0 * double(k) - 1);
    const double term = std::exp((2.0 * double(n) + 1) * std::log(double(k)) -
                                 std::lgamma(double(n + k) + 1) - std::lgamma(double(n - k) + 1));
    sum += (n - k) % 2 == 0 ? term : -term;
  }
  return double(n) * std::log(2.0) - log_odd + std::log(std::max(sum, 1e-300));
}

double Periodogram::false_alarm(const PeriodCandidate& c) const {
  // The times are spread evenly over the line: their variance is its length^2 / 12.
  const double time_px = light_.length_px * std::sqrt(4 * pi / 12);
  double sum = 0.0;
  for (std::size_t h = 1; h <= max_harmonics; ++h) {
    const double range = highest_frequency(light_) / double(h) - 1 / light_.length_px;
    if (!(range > 0)) break;
    const double z = (c.score + 2 * double(h) * price()) / 2;
    if (!(z > 0)) return 1.0;
    sum +=
        std::exp(std::log(range * time_px) + log_factor(h) - z + (double(h) - 0.5) * std::log(z)) +
        std::exp(-z);
  }
  return std::min(sum, 1.0);
}

/// The periodic light by its phase.
class Wave {
 public:
  Wave(std::span<const double> coefficients, double frequency)
      : coefficients_(coefficients), frequency_(frequency) {}

  double at_phase(double turn) const {
    double sum = 0.0;
    for (std::size_t h = 1; 2 * h <= coefficients_.size(); ++h)
      sum += coefficients_[2 * h - 2] * std::cos(double(h) * turn) +
             coefficients_[2 * h - 1] * std::sin(double(h) * turn);
    return sum;
  }
  double at(double along_px) const { return at_phase(2 * pi * frequency_ * along_px); }

  /// Phases of least and most light.
  std::pair<double, double> extremes() const {
    std::pair<double, double> out{0.0, 0.0};
    double least = HUGE_VAL, most = -HUGE_VAL;
    for (int k = 0; k < phases; ++k) {
      const double turn = 2 * pi * k / phases, value = at_phase(turn);
      if (value < least) least = value, out.first = turn;
      if (value > most) most = value, out.second = turn;
    }
    return out;
  }

 private:
  std::span<const double> coefficients_;
  double frequency_;
};

/// How often a phase is on the line.
int times_on_line(double turn, double frequency, double length_px) {
  const double cycles = frequency * length_px / 2, place = turn / (2 * pi);
  return int(std::floor(cycles - place) - std::ceil(-cycles - place)) + 1;
}

/// Whether the line shows what repeats at least twice: flashes, dips, or one whole sine.
bool repeats(const Wave& wave, const PeriodCandidate& c, double length_px) {
  if (c.harmonics == 1) return c.frequency * length_px >= 1.0;
  const auto [least, most] = wave.extremes();
  const bool flashes = wave.at_phase(most) > -wave.at_phase(least);
  return times_on_line(flashes ? most : least, c.frequency, length_px) >= 2;
}

/// How far beyond an end the light stays nearly dark, at most a period.
double dark_beyond(const Wave& wave, double even, double end_px, double side, double period_px) {
  constexpr double dark = 0.15;  // largest share of the mean light
  constexpr int steps_of_period = 100;
  for (int k = 0; k < steps_of_period; ++k) {
    const double way_px = k * period_px / steps_of_period;
    if (even + wave.at(end_px + side * way_px) > dark * even) return way_px;
  }
  return 0.0;
}

/// Sets the amplitude and its error, by how it changes with each coefficient.
void set_amplitude(const Periodogram::Solution& fit, const Wave& wave, double misfit,
                   LightPeriod& out) {
  const auto [least, most] = wave.extremes();
  const double even = fit.value[even_light];
  out.amplitude = (wave.at_phase(most) - wave.at_phase(least)) / (2 * even);
  std::vector<double> by(fit.value.size(), 0.0);
  by[even_light] = -out.amplitude / even;
  for (std::size_t i = others; i < by.size(); ++i) {
    const auto h = double((i - others) / 2 + 1);
    const bool cosine = (i - others) % 2 == 0;
    by[i] = (cosine ? std::cos(h * most) - std::cos(h * least)
                    : std::sin(h * most) - std::sin(h * least)) /
            (2 * even);
  }
  const std::vector<double> spread = fit.factor.solve(by);
  double variance = 0.0;
  for (std::size_t i = 0; i < by.size(); ++i) variance += by[i] * spread[i];
  out.amplitude_sigma = std::sqrt(std::max(variance, 0.0) * misfit);
}

}  // namespace

std::optional<FoundPeriod> light_period(const StreakLight& light) {
  const Periodogram periodogram(light);
  const PeriodCandidate best = periodogram.best();
  if (best.harmonics == 0 || !(best.frequency > 0)) return std::nullopt;
  FoundPeriod found;
  LightPeriod& out = found.period;
  out.harmonics = std::uint32_t(best.harmonics);
  out.false_alarm = periodogram.false_alarm(best);
  if (out.false_alarm > max_false_alarm || !periodogram.beats_bend(best)) return std::nullopt;
  const auto fit = periodogram.solution(best);
  if (!fit || !(fit->value[even_light] > 0)) return std::nullopt;
  const Wave wave(std::span(fit->value).subspan(others), best.frequency);
  if (!repeats(wave, best, light.length_px)) return std::nullopt;
  out.period_px = 1 / best.frequency;
  out.period_sigma_px = periodogram.sigma_of(best) * out.period_px * out.period_px;
  if (!(out.period_sigma_px < 0.2 * out.period_px)) return std::nullopt;
  set_amplitude(*fit, wave, light.misfit(), out);
  const double even = fit->value[even_light];
  const double half = light.length_px / 2;
  found.dark_first_px = dark_beyond(wave, even, -half, -1, out.period_px);
  found.dark_last_px = dark_beyond(wave, even, half, 1, out.period_px);
  return found;
}

}  // namespace dmise
