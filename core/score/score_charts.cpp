#include "core/score/score_charts.h"

#include <algorithm>
#include <cmath>

#include "core/base/formatted.h"
#include "core/score/matched_filter.h"

namespace dmise {
namespace {

// Colour-blind safe colours (Okabe and Ito).
constexpr Colour blue = {0, 114, 178}, orange = {230, 159, 0}, red = {213, 94, 0};
constexpr double min_snr = 1.0;

ChartAxis snr_axis(const Score& score) {
  double most = 100.0;
  for (const ScoredTruth& t : score.truths) most = std::max(most, 1.2 * t.snr.value_or(0.0));
  return logarithmic_axis("expected SNR of the matched filter", min_snr, most);
}

ChartAxis linear_axis(const char* label, double least, double most, double step) {
  ChartAxis axis{.label = label, .least = least, .most = most};
  for (double at = least; at < most + 0.5 * step; at += step)
    axis.ticks.push_back({at, formatted("%g", std::round(at / step) * step + 0.0)});
  return axis;
}

/// A small cross; `arm`: of its vertical line.
void add_mark(ChartSeries& series, ChartPoint at, double arm) {
  series.lines.push_back({{at.x * 0.98, at.y}, {at.x * 1.02, at.y}});
  series.lines.push_back({{at.x, at.y - arm}, {at.x, at.y + arm}});
}

/// Root mean square of the errors of clean detections in bins of SNR, as a line.
std::vector<ChartPoint> rms_line(const Score& score, std::optional<double> MatchErrors::*error) {
  std::vector<ChartPoint> line;
  for (double low = min_snr; low < 1e6; low *= std::sqrt(2.0)) {
    double sum = 0.0;
    int count = 0;
    for (const ScoredTruth& t : score.truths) {
      const auto value = t.errors.*error;
      if (!t.clean || !t.snr || !value || *t.snr < low || *t.snr >= low * std::sqrt(2.0)) continue;
      sum += *value * *value;
      ++count;
    }
    if (count >= 3) line.push_back({low * std::pow(2.0, 0.25), std::sqrt(sum / count)});
  }
  return line;
}

/// Each clean detection at `height` of its error, and their rms.
template <class Height>
Chart error_chart(const Score& score, std::optional<double> MatchErrors::*error, Height height) {
  Chart chart{.x = snr_axis(score)};
  ChartSeries each{.label = "clean detections (beyond the axis: at its end)", .colour = blue};
  ChartSeries rms{.label = "rms", .colour = red};
  for (const ScoredTruth& t : score.truths)
    if (const auto value = t.errors.*error; t.clean && t.snr && value) {
      const double y = height(*value);
      add_mark(each, {*t.snr, y}, error == &MatchErrors::flux ? 0.06 * y : 0.08);
    }
  auto line = rms_line(score, error);
  for (ChartPoint& p : line) p.y = height(p.y);
  if (!line.empty()) rms.lines.push_back(line);
  chart.series = {each, rms};
  return chart;
}

}  // namespace

Chart detection_chart(const Score& score) {
  Chart chart{
      .title = "Probability of detection",
      .subtitle = formatted("bins of SNR with 95 %% intervals (Wilson); theory: Q(%g - SNR)",
                            score.settings.threshold_snr),
      .x = snr_axis(score)};
  chart.y = linear_axis("probability of detection", 0.0, 1.0, 0.2);
  chart.y.least = -0.04;
  chart.y.most = 1.04;
  ChartSeries theory{.label = "theory", .colour = orange, .lines = {{}}};
  for (double snr = min_snr; snr < chart.x.most; snr *= 1.01)
    theory.lines[0].push_back({snr, theory_of_detection(snr, score.settings.threshold_snr)});
  ChartSeries measured{.label = "measured", .colour = blue};
  for (const Bin& bin : score.sensors.back().by_snr) {
    const double low = std::max(min_snr, bin.from.value_or(min_snr));
    const double high = std::min(chart.x.most, bin.to.value_or(chart.x.most));
    if (!(high > low)) continue;
    const double at = std::sqrt(low * high), share = double(bin.found) / double(bin.truths);
    measured.lines.push_back({{low, share}, {high, share}});
    measured.lines.push_back({{at, bin.probability.low}, {at, bin.probability.high}});
  }
  chart.series = {theory, measured};
  return chart;
}

Chart position_chart(const Score& score) {
  Chart chart = error_chart(score, &MatchErrors::over_bound,
                            [](double error) { return std::clamp(error, -5.0, 5.0); });
  chart.title = "Error of position across the trail";
  chart.subtitle = "over its Cramer-Rao bound; the best detector has an rms of 1";
  chart.y = linear_axis("error / bound", -5.0, 5.0, 1.0);
  chart.series.push_back(
      {.label = "bound",
       .colour = orange,
       .lines = {{{min_snr, 1.0}, {chart.x.most, 1.0}}, {{min_snr, -1.0}, {chart.x.most, -1.0}}}});
  return chart;
}

Chart magnitude_chart(const Score& score) {
  static constexpr double least = 1e-4, most = 2.0;
  Chart chart = error_chart(score, &MatchErrors::flux,
                            [](double error) { return std::clamp(std::abs(error), least, most); });
  chart.title = "Error of flux";
  chart.subtitle = "electrons in the frame, measured over true; bound on a background: 1.086 / SNR";
  chart.y = logarithmic_axis("absolute error [mag]", least, most);
  chart.series.push_back(
      {.label = "bound",
       .colour = orange,
       .lines = {{{min_snr, 1.0857 / min_snr}, {chart.x.most, 1.0857 / chart.x.most}}}});
  return chart;
}

}  // namespace dmise
