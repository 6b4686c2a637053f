#include "core/score/score_text.h"

#include <algorithm>

#include "core/base/formatted.h"
#include "core/base/printable.h"

namespace dmise {
namespace {

constexpr std::size_t longest_list = 20;

std::string name_of(const SensorScore& s) {
  return s.sensor.empty() ? "total" : printable(s.sensor);
}

std::string share(const Bin& bin) {
  if (bin.truths == 0) return "-";
  return formatted("%.3f [%.3f, %.3f]", double(bin.found) / double(bin.truths), bin.probability.low,
                   bin.probability.high);
}

void add_bins(std::string& text, const char* title, const std::vector<Bin>& bins) {
  if (bins.empty()) return;
  text += formatted("\n%-22s %7s %7s  %-22s %s\n", title, "truths", "found", "probability, 95 %",
                    "theory");
  for (const Bin& bin : bins) {
    std::string range;
    if (!bin.from) range = formatted("below %g", *bin.to);
    if (!bin.to) range = formatted("from %g", bin.from.value_or(0.0));
    if (bin.from && bin.to) range = formatted("%g to %g", *bin.from, *bin.to);
    const std::string theory = bin.theory ? formatted("%.3f", *bin.theory) : "-";
    text += formatted("%-22s %7zu %7zu  %-22s %s\n", range.c_str(), bin.truths, bin.found,
                      share(bin).c_str(), theory.c_str());
  }
}

void add_errors(std::string& text, const SensorScore& s) {
  text += "\nerrors of clean detections (whole, in one piece, not saturated)\n";
  text += formatted("%-46s %10s %11s %11s  %10s %11s %11s\n", "measured - true", "points", "mean",
                    "rms", "streaks", "mean", "rms");
  for (std::size_t k = 0; k < error_keys.size(); ++k) {
    const ErrorFigure &p = s.errors[0][0][k], &q = s.errors[0][1][k];
    if (p.count + q.count == 0) continue;
    text += formatted("%-46s", error_keys[k].what);
    for (const ErrorFigure* f : {&p, &q}) {
      text += f->count > 0 ? formatted(" %10zu %11.4g %11.4g ", f->count, f->mean, f->rms)
                           : formatted(" %10s %11s %11s ", "-", "-", "-");
    }
    text += '\n';
    if (error_keys[k].value != &MatchErrors::nees_px &&
        error_keys[k].value != &MatchErrors::nees_sky)
      continue;
    text += "  honest: mean within";
    for (const ErrorFigure* f : {&p, &q})
      if (f->count > 0) {
        const Interval i = nees_interval(f->count);
        text += formatted("  %.3f..%.3f (%s)", i.low, i.high, f == &p ? "points" : "streaks");
      }
    text += '\n';
  }
}

void add_sensor_errors(std::string& text, const Score& score) {
  struct Column {
    const char* name;
    std::optional<double> MatchErrors::*value;
    enum { root, mean, square } of;  // rms, mean or mean square
  };
  static constexpr Column columns[] = {
      {"along px", &MatchErrors::along_px, Column::root},
      {"across px", &MatchErrors::across_px, Column::root},
      {"along \"", &MatchErrors::along_arcsec, Column::root},
      {"across \"", &MatchErrors::across_arcsec, Column::root},
      {"NEES/2 px", &MatchErrors::nees_px, Column::mean},
      {"NEES/2 sky", &MatchErrors::nees_sky, Column::mean},
      {"/ bound", &MatchErrors::over_bound, Column::root},
      {"flux mag", &MatchErrors::flux, Column::mean},
      {"chi-square", &MatchErrors::flux_over_sigma, Column::square},
      {"end px", &MatchErrors::end_along_px, Column::root},
      {"end s", &MatchErrors::end_time_s, Column::root}};
  text += formatted("\n%-29s %6s", "rms (of NEES and flux: mean)", "clean");
  for (const Column& column : columns) text += formatted(" %10s", column.name);
  for (const SensorScore& s : score.sensors)
    for (const bool streaks : {false, true}) {
      const auto& figures = s.errors[0][streaks];
      if (figures[0].count == 0) continue;
      text += formatted("\n%-20s %-8s %6zu", name_of(s).c_str(), streaks ? "streaks" : "points",
                        figures[0].count);
      for (const Column& column : columns) {
        const auto k = std::ranges::find(error_keys, column.value, &ErrorKey::value);
        const ErrorFigure& f = figures[std::size_t(k - error_keys.begin())];
        const double value = column.of == Column::root   ? f.rms
                             : column.of == Column::mean ? f.mean
                                                         : f.rms * f.rms;
        text += f.count > 0 ? formatted(" %10.4g", value) : formatted(" %10s", "-");
      }
    }
  text += '\n';
}

}  // namespace

std::string score_table(const Score& score) {
  std::string text;
  if (score.status != "complete")
    text +=
        printable(score.source) + ": the run is not complete: " + printable(score.status) + "\n";
  text += formatted("%-20s %6s %8s %7s %7s %7s %6s %6s %8s %9s  %-22s %7s %9s %8s\n", "sensor",
                    "frames", "Mpx", "found", "missed", "faint", "dark", "out", "unscored",
                    "in pieces", "probability, 95 %", "false", "per frame", "per Mpx");
  for (const SensorScore& s : score.sensors) {
    const double frames = double(s.frames - s.unsearched_frames);
    text += formatted("%-20s %6zu %8.1f", name_of(s).c_str(), s.frames, s.megapixels);
    text += formatted(" %7zu %7zu %7zu %6zu %6zu %8zu", s.fates[0], s.fates[1], s.fates[2],
                      s.fates[3], s.fates[4], s.fates[5]);
    text += formatted(" %9zu  %-22s %7zu", s.in_pieces, share(s.detection).c_str(), s.false_alarms);
    text += formatted(" %9.3g %8.3g\n", frames > 0 ? double(s.false_alarms) / frames : 0.0,
                      s.megapixels > 0 ? double(s.false_alarms) / s.megapixels : 0.0);
  }
  const SensorScore& total = score.sensors.back();
  text += formatted("\nTheory: Q(%g - SNR).", score.settings.threshold_snr);
  if (total.points_threshold)
    text += formatted(" Points fit a threshold of %.2f.", *total.points_threshold);
  if (total.streaks_threshold)
    text += formatted(" Streaks fit a threshold of %.2f.", *total.streaks_threshold);
  text += '\n';
  add_bins(text, "expected SNR", total.by_snr);
  add_bins(text, "magnitude V", total.by_magnitude);
  add_bins(text, "length [px]", total.by_length_px);
  add_bins(text, "rate [arcsec/s]", total.by_rate);
  add_errors(text, total);
  if (score.sensors.size() > 2) add_sensor_errors(text, score);
  std::size_t listed = 0;
  for (const ScoredTruth& t : score.truths) {
    if (t.fate != Fate::missed || ++listed > longest_list) continue;
    if (listed == 1) text += "\nmissed: sensor, frame, name, expected SNR, length, place\n";
    text += formatted("  %-20s %6s  %-30s", printable(t.truth.sensor).c_str(),
                      printable(t.truth.frame, 100).c_str(), printable(t.truth.id, 100).c_str());
    text += t.snr ? formatted(" %8.1f", *t.snr) : formatted(" %8s", "-");
    text += formatted(" %8.1f px  (%.1f, %.1f)\n", t.length_px, t.truth.light->x_px,
                      t.truth.light->y_px);
  }
  if (listed > longest_list) text += formatted("  and %zu more\n", listed - longest_list);
  if (!score.false_alarms.empty()) text += "\nfalse: detection, measured SNR, length, place\n";
  for (std::size_t k = 0; k < std::min(longest_list, score.false_alarms.size()); ++k) {
    const Detection& d = score.false_alarms[k].detection;
    text += formatted("  %-30s %8.1f %8.1f px  (%.1f, %.1f)\n", printable(d.id, 100).c_str(), d.snr,
                      d.length_px, d.x_px, d.y_px);
  }
  if (score.false_alarms.size() > longest_list)
    text += formatted("  and %zu more\n", score.false_alarms.size() - longest_list);
  return text;
}

}  // namespace dmise
