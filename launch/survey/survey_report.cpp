#include "launch/survey/survey_report.h"

#include <algorithm>

#include "core/base/files/json.h"
#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/base/units.h"
#include "core/time/iso8601.h"

namespace dmise {
namespace {

/// "95 s", "12 min", "3.4 h"; "-" without any.
std::string duration(const Revisits& revisits, double seconds) {
  if (revisits.count == 0) return "-";
  if (seconds < 120.0) return formatted("%.0f s", seconds);
  if (seconds < 7200.0) return formatted("%.0f min", seconds / 60.0);
  return formatted("%.1f h", seconds / 3600.0);
}

std::string row(const std::string& name, const ShellSummary& s) {
  return formatted("%-18s %8zu %8zu %10.1f %12.1f %8zu %10s %10s\n", name.c_str(), s.objects,
                   s.covered, s.detected, s.detections, s.visits,
                   duration(s.revisits, s.revisits.median_s).c_str(),
                   duration(s.revisits, s.revisits.most_of_90_s).c_str());
}

std::string shell_table(const Shells& shells, const NightSummary& night) {
  std::string text = formatted("%-18s %8s %8s %10s %12s %8s %10s %10s\n", "shell", "objects",
                               "covered", "detected", "detections", "visits", "revisit", "of 90 %");
  for (std::size_t k = 0; k < shells.shells.size(); ++k)
    if (night.shells[k].objects > 0) text += row(shells.shells[k].name, night.shells[k]);
  return text + row("all", night.all);
}

std::string utc(const SurveyReport& report, SimTime t) {
  return format_utc(report.clock.utc(t), 0);
}

std::string sensor_table(const SurveyReport& report) {
  int width = 6;
  for (const auto& s : report.surveys) width = std::max(width, int(printable(s.sensor).size()));
  std::string text = formatted("%-*s %9s %7s %8s %10s %12s\n", width, "sensor", "exposures",
                               "hours", "covered", "detected", "detections");
  for (std::size_t k = 0; k < report.surveys.size(); ++k) {
    const SensorTotals& t = report.summary.run.sensors[k];
    text += formatted("%-*s %9zu %7.1f %8zu %10.1f %12.1f\n", width,
                      printable(report.surveys[k].sensor).c_str(), t.exposures, t.hours, t.covered,
                      t.detected, t.detections);
  }
  return text;
}

std::string choice_text(const SurveyReport& report) {
  const ChosenNetwork& c = *report.chosen;
  std::string text = formatted("\n%zu of %zu sites, objects detected a night:\n",
                               c.choice.sites.size(), c.candidates.size());
  text +=
      formatted("  greedy search %.1f, after %d moves of single sites %.1f; none of them: %.1f\n",
                c.choice.greedy, c.choice.moves, c.choice.best, c.choice.none);
  text += formatted(
      "  no choice of %zu has more than %.1f: this one has %.1f %% of that (greedy search "
      "guarantees %.1f %% of what sites can add)\n",
      c.choice.sites.size(), c.choice.bound,
      c.choice.bound > 0.0 ? 100.0 * c.choice.best / c.choice.bound : 100.0,
      100.0 * greedy_guarantee);
  text += "  sites:";
  for (const std::size_t s : c.choice.sites) text += " " + printable(c.candidates[s].name);
  text += "\n\nthe chosen network:\n" + shell_table(report.shells, c.summary.run);
  return text;
}

void write_shell(JsonWriter& json, const std::string& name, const ShellSummary& s) {
  json.begin_object().field("shell", name);
  json.field("objects", s.objects).field("covered", s.covered);
  json.field("detected", s.detected).field("detections", s.detections);
  json.field("visits", s.visits).field("revisits", s.revisits.count);
  const auto if_any = [&](double seconds) {
    return s.revisits.count > 0 ? std::optional(seconds) : std::nullopt;
  };
  json.field("revisit_median_s", if_any(s.revisits.median_s));
  json.field("revisit_90_s", if_any(s.revisits.most_of_90_s)).end_object();
}

void write_shells(JsonWriter& json, const Shells& shells, const NightSummary& night) {
  json.key("shells").begin_array();
  for (std::size_t k = 0; k < shells.shells.size(); ++k)
    write_shell(json, shells.shells[k].name, night.shells[k]);
  json.end_array().key("all");
  write_shell(json, "all", night.all);
}

void write_sensors(JsonWriter& json, const SurveyReport& report, const NightSummary& night) {
  json.key("sensors").begin_array();
  for (std::size_t k = 0; k < report.surveys.size(); ++k) {
    const SensorTotals& t = night.sensors[k];
    json.begin_object().field("name", report.surveys[k].sensor);
    json.field("exposures", t.exposures).field("hours", t.hours);
    json.field("covered", t.covered).field("detected", t.detected);
    json.field("detections", t.detections).end_object();
  }
  json.end_array();
}

void write_model(JsonWriter& json, const DetectionModel& model) {
  json.key("detection").begin_object().field("share", model.share);
  json.field("share_of_points", model.share_points);
  json.field("share_of_points_among_long_trails", model.share_far);
  json.field("share_among_round_stars", model.share_round);
  const auto write = [&](const char* list, const auto& nodes, const char* px = "length_px") {
    json.key(list).begin_array();
    for (const auto& node : nodes)
      json.begin_object()
          .field(px, node.px)
          .field("half_snr", node.half_snr)
          .field("spread", node.spread)
          .end_object();
    json.end_array();
  };
  write("among_trailed_stars", model.trailed);
  write("points_among_long_trails", model.far);
  write("among_round_stars", model.round);
  write("among_round_stars_that_are_known", model.round_known);
  write("by_shape", model.shape, "difference_px");
  json.end_object();
}

void write_choice(JsonWriter& json, const SurveyReport& report) {
  const ChosenNetwork& c = *report.chosen;
  json.key("optimised").begin_object();
  json.field("candidates", c.candidates.size());
  json.key("sites").begin_array();
  for (const std::size_t s : c.choice.sites) json.value(c.candidates[s].name);
  json.end_array().list("greedy_detected", c.choice.detected);
  json.field("detected_per_night", c.choice.best).field("detected_by_greedy", c.choice.greedy);
  json.field("detected_without_sites", c.choice.none).field("moves", c.choice.moves);
  json.field("bound", c.choice.bound).field("greedy_guarantee", greedy_guarantee);
  write_shells(json, report.shells, c.summary.run);
  json.end_object();
}

}  // namespace

std::string survey_text(const SurveyReport& report) {
  std::string text = formatted("%s to %s, %s, the Sun below %g deg\n", utc(report, {0}).c_str(),
                               utc(report, report.scenario.duration).c_str(),
                               counted(report.shells.of_object.size(), "object").c_str(),
                               report.night_below_rad / deg);
  text += sensor_table(report);
  const auto& nights = report.summary.nights;
  for (std::size_t k = 0; k < nights.size(); ++k) {
    text += formatted("\nnight %zu, from %s\n", k + 1,
                      utc(report, {std::int64_t(k) * night_ns}).c_str());
    text += shell_table(report.shells, nights[k]);
  }
  if (nights.size() > 1) text += "\nall nights\n" + shell_table(report.shells, report.summary.run);
  if (report.chosen) text += choice_text(report);
  if (report.check)
    text += formatted("\n%zu rendered frames: %.1f detections expected, %zu found: %+.2f sigma\n",
                      report.check->frames, report.check->expected(), report.check->found(),
                      report.check->deviation_sigma());
  return text;
}

std::string survey_json(const SurveyReport& report) {
  JsonWriter json;
  json.begin_object().field("scenario", report.scenario.path);
  json.field("start_utc", utc(report, {0})).field("end_utc", utc(report, report.scenario.duration));
  json.field("objects", report.shells.of_object.size());
  json.field("night_deg", report.night_below_rad / deg);
  write_model(json, report.model);
  json.key("nights").begin_array();
  for (std::size_t k = 0; k < report.summary.nights.size(); ++k) {
    json.begin_object().field("start_utc", utc(report, {std::int64_t(k) * night_ns}));
    write_sensors(json, report, report.summary.nights[k]);
    write_shells(json, report.shells, report.summary.nights[k]);
    json.end_object();
  }
  json.end_array().key("run").begin_object();
  write_sensors(json, report, report.summary.run);
  write_shells(json, report.shells, report.summary.run);
  json.end_object();
  if (report.chosen) write_choice(json, report);
  if (report.check) {
    json.key("check").begin_object().field("frames", report.check->frames);
    json.field("expected", report.check->expected());
    json.field("found", report.check->found());
    json.field("sigma", report.check->sigma());
    json.field("deviation_sigma", report.check->deviation_sigma()).end_object();
  }
  json.end_object();
  return json.take() + "\n";
}

}  // namespace dmise
