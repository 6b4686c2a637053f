#include "bench/validation/detector_figures.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "core/base/formatted.h"
#include "core/score/trail.h"

namespace dmise {
namespace {

constexpr const char* about_drawn_frames = R"(
## Detection in drawn frames

Frames of 1000 x 1000 pixels that the program draws from a seed, 60 of each kind: a telescope of 0.3 m on La Palma, 3.1 arcsec a pixel, a dark
sky, stars of the catalogue and, fainter, by counts. It looks from east to west, a step of 3 deg a frame, through the Milky Way of the winter.
16 satellites are in each frame, on a grid and a little beside it, with an SNR of 3 to 100, uniform in its logarithm. Where they are
streaks, the mount follows the stars for 0.2 s, and the orbits are circular, at a range of 800 to 4000 km. Where they are points, the mount and
they stand over the ground for 5 s, and stars trail by 20 px. `dmise score` compares what is detected with the truth.

- **SNR**: of the ideal matched filter, by the light in the frame and the noise that was measured. **ideal filter**: Q(6 - SNR).
- **completeness**: the share that is found, with the 95 % interval of a binomial share (Wilson). **by `survey`**: the mean of the probability
  that [`dmise survey`](models/survey.md#probability-of-detection) has for these objects. Its table was measured in frames of an all-sky camera, and
  does not know how many stars are in the field.
- **rms over sigma**: errors of position in pixels over the standard deviations that detections state, across the streak and along it (points:
  y and x). **magnitude**: measured less true V; above 0 the detector finds too little light. Both are of clean detections: whole, in one piece,
  not saturated.
- **By SImSiT**: as the tracking task of LLNL's Satellite Image Simulation Toolkit scores (`branches/tracking/score_submission.py` of LLNL/SImSiT at
  906a8a1). A satellite is found if the squared errors of its two ends sum to less than 400 px2. The completeness is the share of satellites
  found, the false positive rate the share of detections that belong to none. The RMSE of xy is the root of the mean of that sum; that of flux
  is in magnitudes. A point has both ends at its place. Of the candidates for a satellite the one that `dmise score` assigns is taken, where SImSiT takes
  the nearest; satellites whose ends are outside the frame are left out. Their frames are not ours: the figures are of the same kind, not to
  be ranked with theirs.

What differs: among many stars `survey` expects too much, of bright points and of faint streaks. Away from the trails of stars nearly all bright points are
found; within two widths of the point spread of a trail nearly none, for their pixels are one with the trail's. A brighter point has more pixels, and
touches more trails. Among fewer stars `survey` is right for bright points and streaks; of faint ones, more points and fewer streaks are
found than it expects. Near the threshold what is found is too bright, since noise helped.

This does not show: errors that drawing and detecting share, as the shape of the point spread; clouds, structure of the sky, defects; other
cameras and lengths; satellites that flicker. `reference.galsim_detect` and
[the comparison with others](detection.md#comparison-with-sep-and-source-extractor) detect in frames that GalSim draws.
)";

constexpr double simsit_gate_px2 = 400.0;  // sum of the squared errors of both ends

/// Standard deviation that a detection states for a direction.
double sigma_along(const Detection& d, PixelPosition unit) {
  const auto [xx, xy, yy] = d.covariance_px2;
  return std::sqrt(unit.x_px * unit.x_px * xx + 2.0 * unit.x_px * unit.y_px * xy +
                   unit.y_px * unit.y_px * yy);
}

std::optional<double> over(const std::optional<double>& error, double sigma) {
  return error && sigma > 0.0 ? std::optional(*error / sigma) : std::nullopt;
}

void add_errors(const ScoredTruth& t, SnrRow& row) {
  if (!t.clean) return;
  const TrueTrail trail(t.truth.start, t.truth.middle, t.truth.end);
  const PixelPosition along = t.is_point() ? PixelPosition{1.0, 0.0} : trail.direction(0.5);
  row.along_sigma.add(over(t.errors.along_px, sigma_along(*t.detection, along)));
  row.across_sigma.add(
      over(t.errors.across_px, sigma_along(*t.detection, {-along.y_px, along.x_px})));
  row.magnitude.add(t.errors.magnitude);
  row.magnitude_sigma.add(t.errors.magnitude_over_sigma);
}

void add_truth(const ScoredTruth& t, double expected, SnrRow& row) {
  row.expected += expected;
  if (t.fate == Fate::found) add_errors(t, row);
}

constexpr double min_charted_snr = 3.0, max_charted_snr = 100.0;

bool is_charted(const Bin& bin) {
  return bin.from && bin.to && *bin.from >= min_charted_snr && *bin.to <= max_charted_snr;
}

bool is_in(const Bin& bin, double snr) {
  return (!bin.from || snr >= *bin.from) && (!bin.to || snr < *bin.to);
}

/// Sum of the squared errors of both ends; of a point twice that of its place. Empty: not found.
std::optional<double> ends_px2(const ScoredTruth& t) {
  if (t.fate != Fate::found) return std::nullopt;
  const MatchErrors& e = t.errors;
  const auto square = [](const std::optional<double>& x) { return *x * *x; };
  if (e.start_along_px)
    return square(e.start_along_px) + square(e.start_across_px) + square(e.end_along_px) +
           square(e.end_across_px);
  if (!t.is_point()) return std::nullopt;
  return 2.0 * (square(e.along_px) + square(e.across_px));
}

SimsitFigures simsit_of(const std::vector<const ScoredTruth*>& truths, const SensorScore& score) {
  ErrorSum ends, flux;
  std::size_t whole = 0, beside = 0;  // `beside`: their detections are farther off
  for (const ScoredTruth* t : truths) {
    if (!t->truth.whole) continue;  // its ends are not in the frame
    ++whole;
    const auto px2 = ends_px2(*t);
    if (!px2 || *px2 >= simsit_gate_px2) {
      beside += t->fate == Fate::found;
      continue;
    }
    ends.add(std::sqrt(*px2));
    flux.add(t->errors.flux);
  }
  const double detections = double(std::max<std::size_t>(score.detections, 1));
  return {.completeness = whole ? double(ends.count) / double(whole) : 0.0,
          .false_positive_rate = double(score.false_alarms + beside) / detections,
          .xy_rmse_px = ends.rms(),
          .flux_rmse_mag = flux.rms()};
}

/// Completeness of bright points beside trails of stars.
void add_distance(const ScoredDraws& drawn, const ScoredTruth& t, std::vector<DistanceRow>& rows) {
  constexpr double bright_snr = 12.0;
  const auto distance = drawn.star_px.find({t.truth.frame, t.truth.id});
  if (*t.snr < bright_snr || distance == drawn.star_px.end()) return;
  if (rows.empty()) rows = {{.to_px = 4.0}, {.to_px = 8.0}, {.to_px = HUGE_VAL}};
  auto row = rows.begin();
  while (distance->second >= row->to_px && std::next(row) != rows.end()) ++row;
  ++row->truths;
  row->found += t.fate == Fate::found;
}

DetectorFigures figures_of_sensor(const ScoredDraws& drawn, const SensorScore& s) {
  DetectorFigures out{.sensor = s.sensor, .frames = s.frames};
  for (const Bin& bin : s.by_snr)
    if (bin.truths > 0) out.rows.push_back({.bin = bin});
  std::vector<const ScoredTruth*> truths;
  double variance = 0.0;
  for (const ScoredTruth& t : drawn.score.truths) {
    if (t.truth.sensor != s.sensor || !t.has_light() || !t.snr) continue;
    truths.push_back(&t);
    const double expected = drawn.expected(t.truth);
    variance += expected * (1.0 - expected);
    add_truth(t, expected, out.all);
    add_distance(drawn, t, out.by_star_px);
    out.all.bin.truths += 1;
    out.all.bin.found += t.fate == Fate::found;
    for (SnrRow& row : out.rows)
      if (is_in(row.bin, *t.snr)) add_truth(t, expected, row);
  }
  out.all.bin.probability = wilson_interval(out.all.bin.found, out.all.bin.truths);
  out.sigma_found = std::sqrt(variance);
  out.false_alarms_a_frame = double(s.false_alarms) / double(s.frames);
  const bool streaks = s.sensor.starts_with(streak_sensor);
  for (std::size_t k = 0; k < error_keys.size(); ++k) {
    const double rms = s.errors[0][streaks][k].rms;
    if (error_keys[k].value == &MatchErrors::across_arcsec) out.across_arcsec = rms;
    if (error_keys[k].value == &MatchErrors::along_arcsec) out.along_arcsec = rms;
  }
  out.simsit = simsit_of(truths, s);
  return out;
}

std::string range_of(const Bin& bin) {
  if (!bin.from && !bin.to) return "all";
  if (!bin.from) return formatted("below %g", *bin.to);
  return bin.to ? formatted("%g to %g", *bin.from, *bin.to) : formatted("from %g", *bin.from);
}

std::string snr_row(const SnrRow& row) {
  const double truths = double(row.bin.truths);
  std::string text =
      formatted("| %s | %zu | %zu | %.2f (%.2f to %.2f) | %.2f |", range_of(row.bin).c_str(),
                row.bin.truths, row.bin.found, double(row.bin.found) / truths,
                row.bin.probability.low, row.bin.probability.high, row.expected / truths);
  text += row.bin.theory ? formatted(" %.2f |", *row.bin.theory) : std::string(" |");
  if (row.along_sigma.count == 0) return text + " | | | |\n";
  return text + formatted(" %.2f, %.2f | %+.3f | %.3f | %.2f |\n", row.across_sigma.rms(),
                          row.along_sigma.rms(), row.magnitude.mean(), row.magnitude.rms(),
                          row.magnitude_sigma.rms());
}

std::string title_of(const DetectorFigures& f) {
  const bool streaks = f.sensor.starts_with(streak_sensor), few = f.sensor.ends_with(few_stars);
  return formatted("\n### %s, %s than %u stars\n\n",
                   streaks ? "Streaks among round stars" : "Points among stars that trail",
                   few ? "fewer" : "more", stars_of_dense_frame);
}

std::string distance_text(const std::vector<DistanceRow>& rows) {
  if (rows.empty()) return "";
  std::string text =
      "\nPoints with an SNR of 12 and more by their distance to the nearest trail that stands out:";
  double from_px = 0.0;
  for (const DistanceRow& row : rows) {
    text += std::isfinite(row.to_px) ? formatted(" %g to %g px", from_px, row.to_px)
                                     : formatted(" %g px and more", from_px);
    text += formatted(" %zu of %zu found%s", row.found, row.truths,
                      std::isfinite(row.to_px) ? "," : ".\n");
    from_px = row.to_px;
  }
  return text;
}

std::string table_of(const DetectorFigures& f) {
  std::string text = title_of(f);
  text +=
      "| SNR | drawn | found | completeness, 95 % | by `survey` | ideal filter | rms over sigma: "
      "across, along | magnitude: "
      "mean | rms | rms over sigma |\n|---|---|---|---|---|---|---|---|---|---|\n";
  for (const SnrRow& row : f.rows) text += snr_row(row);
  text += snr_row(f.all);
  text += formatted(
      "\n%zu frames: %.2f false positives a frame; %zu found, %.1f expected by `dmise survey` "
      "(%+.1f sigma); rms of directions "
      "%.2f arcsec across, %.2f along. By SImSiT: completeness %.3f, false positive rate %.3f, xy "
      "RMSE %.2f px, flux RMSE %.3f "
      "mag.\n",
      f.frames, f.false_alarms_a_frame, f.all.bin.found, f.all.expected, f.deviation_sigma(),
      f.across_arcsec, f.along_arcsec, f.simsit.completeness, f.simsit.false_positive_rate,
      f.simsit.xy_rmse_px, f.simsit.flux_rmse_mag);
  return text + distance_text(f.by_star_px);
}

}  // namespace

void ErrorSum::add(const std::optional<double>& value) {
  if (!value) return;
  ++count;
  sum += *value;
  squares += *value * *value;
}

double ErrorSum::rms() const { return count ? std::sqrt(squares / double(count)) : 0.0; }

double DetectorFigures::deviation_sigma() const {
  return sigma_found > 0.0 ? (double(all.bin.found) - all.expected) / sigma_found : 0.0;
}

std::vector<DetectorFigures> detector_figures(const ScoredDraws& drawn) {
  std::vector<DetectorFigures> out;
  for (const SensorScore& s : drawn.score.sensors)
    if (!s.sensor.empty()) out.push_back(figures_of_sensor(drawn, s));
  return out;
}

Chart completeness_chart(const std::vector<DetectorFigures>& sensors, const std::string& kind) {
  Chart chart{
      .title =
          kind == streak_sensor ? "Streaks among round stars" : "Points among stars that trail",
      .subtitle = "share that is found, and the mean probability that dmise survey expects",
      .x = logarithmic_axis("SNR of the ideal matched filter", min_charted_snr, max_charted_snr),
      .y = {.label = "completeness",
            .ticks = {{0.0, "0"}, {0.25, "0.25"}, {0.5, "0.5"}, {0.75, "0.75"}, {1.0, "1"}}}};
  for (const DetectorFigures& f : sensors) {
    if (!f.sensor.starts_with(kind)) continue;
    const bool few = f.sensor.ends_with(few_stars);
    const std::string stars =
        formatted("%s than %u stars", few ? "fewer" : "more", stars_of_dense_frame);
    ChartSeries found{
        .label = stars, .colour = few ? Colour{31, 119, 180} : Colour{214, 39, 40}, .lines = {{}}};
    ChartSeries expected{.label = stars + ", by survey",
                         .colour = few ? Colour{174, 199, 232} : Colour{255, 187, 120},
                         .lines = {{}}};
    for (const SnrRow& row : f.rows) {
      if (!is_charted(row.bin)) continue;
      const double snr = std::sqrt(*row.bin.from * *row.bin.to), truths = double(row.bin.truths);
      found.lines[0].push_back({snr, double(row.bin.found) / truths});
      expected.lines[0].push_back({snr, row.expected / truths});
    }
    chart.series.push_back(std::move(expected));
    chart.series.push_back(std::move(found));
  }
  return chart;
}

std::string detector_section(const std::vector<DetectorFigures>& sensors,
                             const std::string& pictures) {
  std::string text = about_drawn_frames;
  for (const char* kind : {point_sensor, streak_sensor})
    text += formatted("\n![Completeness of %s by SNR](%s/%s.svg)\n", kind, pictures.c_str(), kind);
  for (const DetectorFigures& f : sensors) text += table_of(f);
  return text;
}

}  // namespace dmise
