#include "core/detection/curve/light_period.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <utility>
#include <vector>

#include "core/base/numeric/golden_section.h"
#include "core/base/units.h"
#include "core/detection/curve/line_equations.h"
#include "core/detection/curve/period_evidence.h"

namespace dmise {
namespace {

constexpr std::size_t searched_harmonics = 16, max_harmonics = 40;
constexpr double steps = 4.0;  // frequency steps for a cycle more of the highest harmonic
constexpr std::size_t max_peaks = 8;
constexpr double share_uneven = 0.02;            // share of the gain in chi2 that need not repeat
const double min_over_free = std::log(30.0);     // evidence over that of light that does not repeat
const double min_over_longer = std::log(100.0);  // by which a shorter period is ruled out
constexpr int phases = 720;  // places in a period at which its light is looked at

struct Peak {
  double frequency = 0.0, log_evidence = -HUGE_VAL;
};

/// Evidence of frequencies of a streak's light.
class PeriodSearch {
 public:
  PeriodSearch(const StreakLight& light, const LineEquations& line)
      : line_(line), length_px_(light.length_px), misfit_(light.misfit()), bins_(line.bins()) {
    free_gain_ = free_fit(bins_, line.even_e(), misfit_).gain();
    const double uneven = share_uneven * free_gain_ / double(std::max(bins_.right.size(), one));
    searched_misfit_ = misfit_ * (1 + uneven);
    scan();
    find_peaks();
  }

  /// The frequency with the greatest evidence of those that the line shows once.
  std::optional<Peak> best() const {
    return peaks_.empty() ? std::nullopt : std::optional(peaks_.front());
  }

  /// Evidence of light that does not repeat on the line.
  double free_evidence() const {
    double most = free_fit(bins_, line_.even_e(), searched_misfit_).log_evidence();
    for (const Peak& at : scanned_)
      if (at.frequency * length_px_ < 1) most = std::max(most, at.log_evidence);
    return most;
  }

  /// The shortest period that explains the light nearly as well as the best of all.
  double min_period_px() const {
    double most = 0.0, highest = 0.5 / length_px_;
    for (const auto& some : {scanned_, peaks_})
      for (const Peak& at : some) most = std::max(most, at.log_evidence);
    for (std::size_t i = 0; i + 1 < scanned_.size(); ++i)
      if (scanned_[i].log_evidence > most - min_over_longer) highest = scanned_[i + 1].frequency;
    for (const Peak& peak : peaks_)
      if (peak.log_evidence > most - min_over_longer) highest = std::max(highest, peak.frequency);
    return 1 / highest;
  }

  /// With as many harmonics as another frequency has.
  double full_evidence(double frequency, double as_at, double misfit) const {
    return log_evidence(line_.harmonics(frequency, max_harmonics, as_at), all_wave_priors(),
                        line_.even_e(), misfit);
  }
  WaveFit fit(double frequency) const {
    return best_fit(line_.harmonics(frequency, max_harmonics, frequency), line_.even_e(), misfit_);
  }
  /// By which squares of errors exceed those of noise, if light repeats so.
  double misfit_of(const LightFit& fit) const {
    const double missed = (free_gain_ - fit.gain()) / double(std::max(bins_.right.size(), one));
    return misfit_ * std::max(1.0, missed);
  }
  double searched_misfit() const { return searched_misfit_; }
  double frequency_step(double frequency) const {
    const auto most = std::max(line_.harmonics_at(frequency, searched_harmonics), one);
    return 1 / (steps * double(most) * length_px_);
  }
  /// Logarithm of the range of frequencies that are tried for a period.
  double log_range() const { return std::log(line_.highest_frequency() * length_px_); }

 private:
  static constexpr std::size_t one = 1;

  double quick_evidence(double frequency, double as_at) const {
    return log_evidence(line_.harmonics(frequency, searched_harmonics, as_at), few_wave_priors(),
                        line_.even_e(), searched_misfit_);
  }
  /// From twice the line on, where nothing repeats.
  void scan() {
    for (double f = 0.5 / length_px_; f <= line_.highest_frequency(); f += frequency_step(f))
      scanned_.push_back({f, quick_evidence(f, f)});
  }
  void find_peaks() {
    for (std::size_t i = 1; i + 1 < scanned_.size(); ++i)
      if (scanned_[i].frequency * length_px_ >= 1 &&
          scanned_[i].log_evidence > scanned_[i - 1].log_evidence &&
          scanned_[i].log_evidence >= scanned_[i + 1].log_evidence)
        peaks_.push_back(scanned_[i]);
    const auto higher = [](const Peak& a, const Peak& b) {
      return a.log_evidence > b.log_evidence;
    };
    std::ranges::stable_sort(peaks_, higher);
    if (peaks_.size() > max_peaks) peaks_.resize(max_peaks);
    for (Peak& peak : peaks_) peak = refined(peak);
    std::ranges::stable_sort(peaks_, higher);
  }
  /// The best frequency within a step, with all harmonics and priors.
  Peak refined(const Peak& peak) const {
    const double step = frequency_step(peak.frequency);
    const Least least = golden_section([&](double f) { return -quick_evidence(f, peak.frequency); },
                                       peak.frequency - step, peak.frequency + step, 1e-3 * step);
    return {least.at, full_evidence(least.at, least.at, searched_misfit_)};
  }

  const LineEquations& line_;
  double length_px_, misfit_, free_gain_ = 0.0;
  double searched_misfit_ = 1.0;  // with what need not repeat
  LightEquations bins_;
  std::vector<Peak> scanned_;
  std::vector<Peak> peaks_;  // by falling evidence
};

/// A frequency by the mean over its evidence.
struct FrequencyEstimate {
  double frequency = 0.0, sigma = 0.0;
};

/// Mean and standard deviation of the evidence around a peak; none if it has no bounds.
std::optional<FrequencyEstimate> estimate(const PeriodSearch& search, double frequency,
                                          double misfit) {
  constexpr int points = 21, rounds = 6;
  constexpr double widths = 5.0, edge = 1e-3;
  double reach = search.frequency_step(frequency);
  FrequencyEstimate out{frequency, 0.0};
  for (int round = 0; round < rounds; ++round) {
    std::array<double, points> at{}, log{};
    const double first = std::max(out.frequency - reach, 0.2 * frequency);
    const double step = (out.frequency + reach - first) / (points - 1);
    for (std::size_t i = 0; i < points; ++i) {
      at[i] = first + double(i) * step;
      log[i] = search.full_evidence(at[i], frequency, misfit);
    }
    const double most = *std::ranges::max_element(log);
    double sum = 0.0, mean = 0.0, square = 0.0;
    for (std::size_t i = 0; i < points; ++i) {
      const double weight = std::exp(log[i] - most);
      sum += weight, mean += weight * at[i];
    }
    mean /= sum;
    for (std::size_t i = 0; i < points; ++i)
      square += std::exp(log[i] - most) * (at[i] - mean) * (at[i] - mean) / sum;
    const double sigma = std::sqrt(square);
    const bool is_cut = std::max(log.front(), log.back()) > most + std::log(edge);
    out = {mean, sigma};
    if (!is_cut && sigma > 0.7 * step) return out;
    reach = is_cut ? 2 * reach : std::max(widths * sigma, 2 * step);
    if (reach > 0.5 * frequency) break;
  }
  return std::nullopt;
}

/// The periodic light by its phase.
class Wave {
 public:
  Wave(std::span<const double> coefficients, double frequency)
      : coefficients_(coefficients), frequency_(frequency) {}

  double frequency() const { return frequency_; }
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

/// How often a phase is on a line.
int times_on_line(double turn, double frequency, double length_px) {
  const double cycles = frequency * length_px / 2, place = turn / (2 * pi);
  return std::max(int(std::floor(cycles - place) - std::ceil(-cycles - place)) + 1, 0);
}

/// Whether the line shows what repeats at least twice: flashes, dips, or one whole sine.
bool repeats(const Wave& wave, std::uint32_t harmonics, const StreakLight& light) {
  constexpr double free_fwhms = 1.5;  // at either end, whose light is free
  const double length_px = light.length_px;
  if (harmonics == 1) return wave.frequency() * length_px >= 1.0;
  const auto [least, most] = wave.extremes();
  const bool flashes = wave.at_phase(most) > -wave.at_phase(least);
  return times_on_line(flashes ? most : least, wave.frequency(),
                       length_px - 2 * free_fwhms * light.fwhm_px) >= 2;
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

/// Harmonics up to the last that is not noise.
std::uint32_t count_harmonics(const LightFit& fit) {
  constexpr double sure = 6.0;
  const std::vector<double> value = fit.values_e();
  std::uint32_t count = 1;
  for (std::size_t h = 1; 2 * h <= value.size(); ++h) {
    double square = 0.0, variance = 0.0;
    for (const std::size_t i : {2 * h - 2, 2 * h - 1}) {
      std::vector<double> one(value.size(), 0.0);
      one[i] = 1.0;
      square += value[i] * value[i], variance += fit.variance(std::move(one));
    }
    if (square > sure * variance) count = std::uint32_t(h);
  }
  return count;
}

/// Even light that is left beside the harmonics.
struct EvenLight {
  double light_e = 0.0, alone_variance_e2 = 0.0;
  std::vector<double> by;  // each harmonic
};

EvenLight even_light_of(const LineEquations& line, const LightEquations& equations,
                        const std::vector<double>& values) {
  EvenLight out{line.even_e(), line.even_variance_e2(), {}};
  for (std::size_t i = 0; i < values.size(); ++i) {
    out.light_e -= equations.even_e[i] * values[i];
    out.by.push_back(-equations.even_e[i]);
  }
  return out;
}

/// Light of the harmonics that the PSF does not leave over that of the others, if they go on to
/// fall as before and all add up, as in a flash.
double unseen_share(const WavePrior& prior, std::size_t harmonics) {
  const double left = std::exp(-double(harmonics) / (2 * prior.harmonics));
  return left / (1 - left);
}

/// Sets the amplitude and its error, by how it changes with each coefficient.
void set_amplitude(const WaveFit& fit, const Wave& wave, const EvenLight& even, double misfit,
                   LightPeriod& out) {
  const auto [least, most] = wave.extremes();
  out.amplitude = (wave.at_phase(most) - wave.at_phase(least)) / (2 * even.light_e);
  std::vector<double> by;
  for (std::size_t i = 0; i < even.by.size(); ++i) {
    const auto h = double(i / 2 + 1);
    const double change = i % 2 == 0 ? std::cos(h * most) - std::cos(h * least)
                                     : std::sin(h * most) - std::sin(h * least);
    by.push_back((change / 2 - out.amplitude * even.by[i]) / even.light_e);
  }
  const double alone = out.amplitude / even.light_e;
  const double unseen = out.amplitude * unseen_share(fit.prior, even.by.size() / 2);
  out.amplitude_sigma = std::sqrt(fit.light.variance(std::move(by)) + unseen * unseen +
                                  alone * alone * even.alone_variance_e2 * misfit);
}

/// The period at a peak, if it is one.
std::optional<FoundPeriod> period_at(const Peak& peak, const PeriodSearch& search,
                                     const LineEquations& line, const StreakLight& light) {
  const double misfit = search.misfit_of(search.fit(peak.frequency).light);
  const auto frequency = estimate(search, peak.frequency, misfit);
  if (!frequency || !(frequency->sigma < 0.2 * frequency->frequency)) return std::nullopt;
  const LightEquations equations =
      line.harmonics(frequency->frequency, max_harmonics, peak.frequency);
  const WaveFit fit = best_fit(equations, line.even_e(), misfit);
  const std::vector<double> values = fit.light.values_e();
  const EvenLight even = even_light_of(line, equations, values);
  const Wave wave(values, frequency->frequency);
  FoundPeriod found;
  LightPeriod& out = found.period.emplace();
  out.harmonics = count_harmonics(fit.light);
  if (!(even.light_e > 0) || !repeats(wave, out.harmonics, light)) return std::nullopt;
  out.period_px = 1 / frequency->frequency;
  out.period_sigma_px = frequency->sigma * out.period_px * out.period_px;
  set_amplitude(fit, wave, even, misfit, out);
  found.dark_first_px = dark_beyond(wave, even.light_e, -light.length_px / 2, -1, out.period_px);
  found.dark_last_px = dark_beyond(wave, even.light_e, light.length_px / 2, 1, out.period_px);
  return found;
}

}  // namespace

FoundPeriod light_period(const StreakLight& light) {
  const LineEquations line(light);
  if (!line.solvable() || !(line.even_e() > 0) || !(line.highest_frequency() * light.length_px > 1))
    return {};
  const PeriodSearch search(light, line);
  const double free_evidence = search.free_evidence();
  const auto peak = search.best();
  double varies = free_evidence;
  if (peak) {
    const auto width = estimate(search, peak->frequency, search.searched_misfit());
    const double share = width ? std::sqrt(2 * pi) * width->sigma / width->frequency : 1.0;
    const double log_odds = peak->log_evidence + std::log(share / search.log_range());
    varies = std::max(varies, log_odds);
    if (log_odds > -std::log(max_false_alarm) && peak->log_evidence > free_evidence + min_over_free)
      if (auto found = period_at(*peak, search, line, light)) {
        found->period->false_alarm = std::exp(-log_odds);
        return *found;
      }
  }
  FoundPeriod found;
  if (varies > -std::log(max_false_alarm)) found.min_period_px = search.min_period_px();
  return found;
}

}  // namespace dmise
