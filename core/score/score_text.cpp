#include "core/score/score_text.h"

#include <algorithm>
#include <cstdio>

#include "core/base/json.h"
#include "core/base/printable.h"
#include "core/base/units.h"

namespace dmise {
namespace {

constexpr std::size_t longest_list = 20;

template <class... Values>
void add(std::string& text, const char* format, Values... values) {
  char line[512];
  std::snprintf(line, sizeof line, format, values...);
  text += line;
}

std::string name_of(const SensorScore& s) {
  return s.sensor.empty() ? "total" : printable(s.sensor);
}

std::string share(const Bin& bin) {
  if (bin.truths == 0) return "-";
  std::string text;
  add(text, "%.3f [%.3f, %.3f]", double(bin.found) / double(bin.truths), bin.probability.low,
      bin.probability.high);
  return text;
}

void add_bins(std::string& text, const char* title, const std::vector<Bin>& bins) {
  if (bins.empty()) return;
  add(text, "\n%-22s %7s %7s  %-22s %s\n", title, "truths", "found", "probability, 95 %", "theory");
  for (const Bin& bin : bins) {
    std::string range;
    if (!bin.from) add(range, "below %g", *bin.to);
    if (!bin.to) add(range, "from %g", bin.from.value_or(0.0));
    if (bin.from && bin.to) add(range, "%g to %g", *bin.from, *bin.to);
    std::string theory = "-";
    if (bin.theory) theory.clear(), add(theory, "%.3f", *bin.theory);
    add(text, "%-22s %7zu %7zu  %-22s %s\n", range.c_str(), bin.truths, bin.found,
        share(bin).c_str(), theory.c_str());
  }
}

void add_errors(std::string& text, const SensorScore& s) {
  text += "\nerrors of clean detections (whole, in one piece, not saturated)\n";
  add(text, "%-46s %10s %11s %11s  %10s %11s %11s\n", "measured - true", "points", "mean", "rms",
      "streaks", "mean", "rms");
  for (std::size_t k = 0; k < error_keys.size(); ++k) {
    const ErrorFigure &p = s.errors[0][0][k], &q = s.errors[0][1][k];
    if (p.count + q.count == 0) continue;
    add(text, "%-46s", error_keys[k].what);
    for (const ErrorFigure* f : {&p, &q}) {
      if (f->count > 0)
        add(text, " %10zu %11.4g %11.4g ", f->count, f->mean, f->rms);
      else
        add(text, " %10s %11s %11s ", "-", "-", "-");
    }
    text += "\n";
    if (error_keys[k].value != &MatchErrors::nees_px &&
        error_keys[k].value != &MatchErrors::nees_sky)
      continue;
    text += "  honest: mean within";
    for (const ErrorFigure* f : {&p, &q})
      if (f->count > 0) {
        const Interval i = nees_interval(f->count);
        add(text, "  %.3f..%.3f (%s)", i.low, i.high, f == &p ? "points" : "streaks");
      }
    text += "\n";
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
  add(text, "\n%-29s %6s", "rms (of NEES and flux: mean)", "clean");
  for (const Column& column : columns) add(text, " %10s", column.name);
  for (const SensorScore& s : score.sensors)
    for (const bool streaks : {false, true}) {
      const auto& figures = s.errors[0][streaks];
      if (figures[0].count == 0) continue;
      add(text, "\n%-20s %-8s %6zu", name_of(s).c_str(), streaks ? "streaks" : "points",
          figures[0].count);
      for (const Column& column : columns) {
        const auto k = std::ranges::find(error_keys, column.value, &ErrorKey::value);
        const ErrorFigure& f = figures[std::size_t(k - error_keys.begin())];
        const double value = column.of == Column::root   ? f.rms
                             : column.of == Column::mean ? f.mean
                                                         : f.rms * f.rms;
        f.count > 0 ? add(text, " %10.4g", value) : add(text, " %10s", "-");
      }
    }
  text += "\n";
}

void optional_field(JsonWriter& json, const char* key, const std::optional<double>& value) {
  json.key(key);
  value ? json.value(*value) : json.null();
}

void write_bin(JsonWriter& json, const Bin& bin) {
  json.begin_object();
  optional_field(json, "from", bin.from);
  optional_field(json, "to", bin.to);
  json.field("truths", std::uint64_t(bin.truths)).field("found", std::uint64_t(bin.found));
  json.field("low", bin.probability.low).field("high", bin.probability.high);
  optional_field(json, "theory", bin.theory);
  json.end_object();
}

void write_bins(JsonWriter& json, const char* key, const std::vector<Bin>& bins) {
  json.key(key).begin_array();
  for (const Bin& bin : bins) write_bin(json, bin);
  json.end_array();
}

void write_errors(JsonWriter& json, const std::array<ErrorFigure, error_keys.size()>& figures) {
  json.begin_object();
  for (std::size_t k = 0; k < error_keys.size(); ++k) {
    const ErrorFigure& f = figures[k];
    json.key(error_keys[k].key).begin_object().field("count", std::uint64_t(f.count));
    optional_field(json, "mean", f.count > 0 ? std::optional(f.mean) : std::nullopt);
    optional_field(json, "rms", f.count > 0 ? std::optional(f.rms) : std::nullopt);
    const bool nees = std::string_view(error_keys[k].key).starts_with("nees");
    if (nees && f.count > 0) {
      const Interval i = nees_interval(f.count);
      json.key("honest").begin_array().value(i.low).value(i.high).end_array();
    }
    if (std::string_view(error_keys[k].key).ends_with("over_sigma") && f.count > 0)
      json.field("reduced_chi_square", f.rms * f.rms);
    json.end_object();
  }
  json.end_object();
}

void write_sensor(JsonWriter& json, const SensorScore& s) {
  const auto count = [&](const char* key, std::size_t n) { json.field(key, std::uint64_t(n)); };
  json.begin_object();
  if (!s.sensor.empty()) json.field("sensor", s.sensor);
  count("frames", s.frames);
  count("frames_not_searched", s.unsearched_frames);
  json.field("megapixels", s.megapixels);
  count("truths", s.truths);
  for (std::size_t k = 0; k < fate_names.size(); ++k) count(fate_names[k], s.fates[k]);
  count("in_pieces", s.in_pieces);
  count("detections", s.detections);
  count("further_pieces", s.further_pieces);
  count("false_alarms", s.false_alarms);
  count("unscored_detections", s.unscored_detections);
  const auto searched = double(s.frames - s.unsearched_frames);
  const auto per = [&](double of) {
    return of > 0.0 ? std::optional(double(s.false_alarms) / of) : std::nullopt;
  };
  optional_field(json, "false_alarms_per_frame", per(searched));
  optional_field(json, "false_alarms_per_megapixel", per(s.megapixels));
  write_bin(json.key("detection"), s.detection);
  optional_field(json, "points_threshold_snr", s.points_threshold);
  optional_field(json, "streaks_threshold_snr", s.streaks_threshold);
  write_bins(json, "by_snr", s.by_snr);
  write_bins(json, "by_magnitude", s.by_magnitude);
  write_bins(json, "by_length_px", s.by_length_px);
  write_bins(json, "by_rate_arcsec_per_s", s.by_rate);
  for (const bool all : {false, true}) {
    json.key(all ? "errors_of_all" : "errors").begin_object();
    write_errors(json.key("points"), s.errors[all][0]);
    write_errors(json.key("streaks"), s.errors[all][1]);
    json.end_object();
  }
  json.end_object();
}

std::string quoted(const std::string& text) {
  if (text.find_first_of(",\"\r\n") == std::string::npos) return text;
  std::string out = "\"";
  for (const char c : text) out += c == '"' ? "\"\"" : std::string(1, c);
  return out + "\"";
}

void cell(std::string& text, const std::optional<double>& value) {
  text += ',';
  if (value) add(text, "%.9g", *value);
}

}  // namespace

std::string score_table(const Score& score) {
  std::string text;
  if (score.status != "complete")
    text +=
        printable(score.source) + ": the run is not complete: " + printable(score.status) + "\n";
  add(text, "%-20s %6s %8s %7s %7s %7s %6s %6s %8s %9s  %-22s %7s %9s %8s\n", "sensor", "frames",
      "Mpx", "found", "missed", "faint", "dark", "out", "unscored", "in pieces",
      "probability, 95 %", "false", "per frame", "per Mpx");
  for (const SensorScore& s : score.sensors) {
    const double frames = double(s.frames - s.unsearched_frames);
    add(text, "%-20s %6zu %8.1f", name_of(s).c_str(), s.frames, s.megapixels);
    add(text, " %7zu %7zu %7zu %6zu %6zu %8zu", s.fates[0], s.fates[1], s.fates[2], s.fates[3],
        s.fates[4], s.fates[5]);
    add(text, " %9zu  %-22s %7zu", s.in_pieces, share(s.detection).c_str(), s.false_alarms);
    add(text, " %9.3g %8.3g\n", frames > 0 ? double(s.false_alarms) / frames : 0.0,
        s.megapixels > 0 ? double(s.false_alarms) / s.megapixels : 0.0);
  }
  const SensorScore& total = score.sensors.back();
  add(text, "\nTheory: Q(%g - SNR).", score.settings.threshold_snr);
  if (total.points_threshold)
    add(text, " Points fit a threshold of %.2f.", *total.points_threshold);
  if (total.streaks_threshold)
    add(text, " Streaks fit a threshold of %.2f.", *total.streaks_threshold);
  text += "\n";
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
    add(text, "  %-20s %6s  %-30s", printable(t.truth.sensor).c_str(),
        printable(t.truth.frame, 100).c_str(), printable(t.truth.id, 100).c_str());
    t.snr ? add(text, " %8.1f", *t.snr) : add(text, " %8s", "-");
    add(text, " %8.1f px  (%.1f, %.1f)\n", t.length_px, t.truth.light->x_px, t.truth.light->y_px);
  }
  if (listed > longest_list) add(text, "  and %zu more\n", listed - longest_list);
  if (!score.false_alarms.empty()) text += "\nfalse: detection, measured SNR, length, place\n";
  for (std::size_t k = 0; k < std::min(longest_list, score.false_alarms.size()); ++k) {
    const Detection& d = score.false_alarms[k].detection;
    add(text, "  %-30s %8.1f %8.1f px  (%.1f, %.1f)\n", printable(d.id, 100).c_str(), d.snr,
        d.length_px, d.x_px, d.y_px);
  }
  if (score.false_alarms.size() > longest_list)
    add(text, "  and %zu more\n", score.false_alarms.size() - longest_list);
  return text;
}

std::string score_json(const Score& score) {
  JsonWriter json;
  json.begin_object().field("status", score.status).field("gate_px", score.settings.gate_px);
  json.field("threshold_snr", score.settings.threshold_snr).key("total");
  write_sensor(json, score.sensors.back());
  json.key("sensors").begin_array();
  for (std::size_t k = 0; k + 1 < score.sensors.size(); ++k) write_sensor(json, score.sensors[k]);
  json.end_array().key("missed").begin_array();
  for (const ScoredTruth& t : score.truths) {
    if (t.fate != Fate::missed) continue;
    json.begin_object().field("sensor", t.truth.sensor).field("frame", t.truth.frame);
    json.field("id", t.truth.id).field("x_px", t.truth.light->x_px);
    json.field("y_px", t.truth.light->y_px).field("length_px", t.length_px);
    optional_field(json, "snr", t.snr);
    json.end_object();
  }
  json.end_array().key("false").begin_array();
  for (const FoundSource& found : score.false_alarms) {
    const Detection& d = found.detection;
    json.begin_object().field("sensor", found.sensor).field("frame", found.frame);
    json.field("id", d.id).field("x_px", d.x_px).field("y_px", d.y_px);
    json.field("length_px", d.length_px).field("snr", d.snr).end_object();
  }
  return json.end_array().end_object().take() + "\n";
}

std::string score_csv(const Score& score) {
  std::string text =
      "sensor,frame,fate,id,detection,pieces,clean,expected_snr,measured_snr,length_px,"
      "rate_arcsec_per_s,magnitude,x_px,y_px";
  for (const ErrorKey& error : error_keys) text += std::string(",error_") + error.key;
  text += "\n";
  for (const ScoredTruth& t : score.truths) {
    text += quoted(t.truth.sensor) + "," + quoted(t.truth.frame) + "," +
            fate_names[std::size_t(t.fate)] + "," + quoted(t.truth.id) + "," +
            quoted(t.detection ? t.detection->id : "");
    add(text, ",%zu,%d", t.pieces, int(t.clean));
    cell(text, t.snr);
    cell(text, t.detection ? std::optional(t.detection->snr) : std::nullopt);
    cell(text, t.length_px);
    cell(text, t.rate_arcsec_per_s);
    cell(text, t.truth.magnitude);
    const PixelPosition place = t.truth.light.value_or(t.truth.middle);
    cell(text, place.x_px);
    cell(text, place.y_px);
    for (const ErrorKey& error : error_keys) cell(text, t.errors.*error.value);
    text += "\n";
  }
  for (const FoundSource& found : score.false_alarms) {
    const Detection& d = found.detection;
    text += quoted(found.sensor) + "," + quoted(found.frame) + ",false,," + quoted(d.id) + ",1,0,";
    cell(text, d.snr);
    cell(text, d.length_px);
    cell(text,
         d.kind == DetectionKind::streak ? std::optional(d.rate_rad_per_s / arcsec) : std::nullopt);
    cell(text, d.magnitude);
    cell(text, d.x_px);
    cell(text, d.y_px);
    text += std::string(error_keys.size(), ',') + "\n";
  }
  return text;
}

}  // namespace dmise
