#include "core/base/files/json.h"
#include "core/base/files/text_fields.h"
#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/base/units.h"
#include "core/products/unknown_fields.h"
#include "core/score/score_text.h"

namespace dmise {
namespace {

void write_bin(JsonWriter& json, const Bin& bin) {
  json.begin_object().field("from", bin.from).field("to", bin.to);
  json.field("truths", bin.truths).field("found", bin.found);
  json.field("low", bin.probability.low).field("high", bin.probability.high);
  json.field("theory", bin.theory).end_object();
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
    json.key(error_keys[k].key).begin_object().field("count", f.count);
    json.field("mean", f.count > 0 ? std::optional(f.mean) : std::nullopt);
    json.field("rms", f.count > 0 ? std::optional(f.rms) : std::nullopt);
    const bool nees = std::string_view(error_keys[k].key).starts_with("nees");
    if (nees && f.count > 0) {
      const Interval i = nees_interval(f.count);
      json.list("honest", {i.low, i.high});
    }
    if (std::string_view(error_keys[k].key).ends_with("over_sigma") && f.count > 0)
      json.field("reduced_chi_square", f.rms * f.rms);
    json.end_object();
  }
  json.end_object();
}

void write_sensor(JsonWriter& json, const SensorScore& s) {
  json.begin_object();
  if (!s.sensor.empty()) json.field("sensor", s.sensor);
  json.field("frames", s.frames).field("frames_not_searched", s.unsearched_frames);
  json.field("megapixels", s.megapixels).field("truths", s.truths);
  for (std::size_t k = 0; k < fate_names.size(); ++k) json.field(fate_names[k], s.fates[k]);
  json.field("in_pieces", s.in_pieces).field("detections", s.detections);
  json.field("further_pieces", s.further_pieces).field("false_alarms", s.false_alarms);
  json.field("unscored_detections", s.unscored_detections);
  const auto searched = double(s.frames - s.unsearched_frames);
  const auto per = [&](double of) {
    return of > 0.0 ? std::optional(double(s.false_alarms) / of) : std::nullopt;
  };
  json.field("false_alarms_per_frame", per(searched));
  json.field("false_alarms_per_megapixel", per(s.megapixels));
  write_bin(json.key("detection"), s.detection);
  json.field("points_threshold_snr", s.points_threshold);
  json.field("streaks_threshold_snr", s.streaks_threshold);
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

void cell(std::string& text, const std::optional<double>& value) {
  text += value ? formatted(",%.9g", *value) : ",";
}

}  // namespace

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
    json.begin_object().field("sensor", t.truth.sensor).field("frame", printable(t.truth.frame));
    json.field("id", printable(t.truth.id)).field("x_px", t.truth.light->x_px);
    json.field("y_px", t.truth.light->y_px).field("length_px", t.length_px);
    json.field("snr", t.snr).end_object();
  }
  json.end_array().key("false").begin_array();
  for (const FoundSource& found : score.false_alarms) {
    const Detection& d = found.detection;
    json.begin_object().field("sensor", found.sensor).field("frame", printable(found.frame));
    json.field("id", printable(d.id)).field("x_px", d.x_px).field("y_px", d.y_px);
    json.field("length_px", d.length_px).field("snr", d.snr).end_object();
  }
  return json.end_array().end_object().take() + "\n";
}

std::string score_csv(const Score& score) {
  const auto label = [](const std::string& text) { return csv_field(formula_free(text)); };
  std::string text =
      "sensor,frame,fate,id,detection,pieces,clean,expected_snr,measured_snr,length_px,"
      "rate_arcsec_per_s,magnitude,x_px,y_px";
  for (const ErrorKey& error : error_keys) text += std::string(",error_") + error.key;
  text += '\n';
  for (const ScoredTruth& t : score.truths) {
    text += label(t.truth.sensor) + "," + label(t.truth.frame) + "," +
            fate_names[std::size_t(t.fate)] + "," + label(t.truth.id) + "," +
            label(t.detection ? t.detection->id : "");
    text += "," + std::to_string(t.pieces) + (t.clean ? ",1" : ",0");
    cell(text, t.snr);
    cell(text, t.detection ? std::optional(t.detection->snr) : std::nullopt);
    cell(text, t.length_px);
    cell(text, t.rate_arcsec_per_s);
    cell(text, t.truth.magnitude);
    const PixelPosition place = t.truth.light.value_or(t.truth.middle);
    cell(text, place.x_px);
    cell(text, place.y_px);
    for (const ErrorKey& error : error_keys) cell(text, t.errors.*error.value);
    text += '\n';
  }
  for (const FoundSource& found : score.false_alarms) {
    const Detection& d = found.detection;
    text += label(found.sensor) + "," + label(found.frame) + ",false,," + label(d.id) + ",1,0,";
    cell(text, d.snr);
    cell(text, d.length_px);
    const auto known = [&](const char* key, double value) {
      return is_unknown(key, found.unknown) ? std::nullopt : std::optional(value);
    };
    cell(text, d.kind == DetectionKind::streak
                   ? known("rate_arcsec_per_s", d.rate_rad_per_s / arcsec)
                   : std::nullopt);
    cell(text, known("magnitude", d.magnitude));
    cell(text, d.x_px);
    cell(text, d.y_px);
    text += std::string(error_keys.size(), ',') + "\n";
  }
  return text;
}

}  // namespace dmise
