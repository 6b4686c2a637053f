#include "launch/run_record.h"

#include <algorithm>
#include <filesystem>
#include <fstream>

#include "core/base/json.h"
#include "core/base/version.h"
#include "core/base/whole_file.h"
#include "core/orbit/interpolation_error.h"
#include "core/products/frame_file.h"
#include "launch/tracks_figure.h"
#include "sensors/pipeline/frame_times.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

bool exists(const std::string& path) {
  std::error_code ignored;
  return fs::exists(path, ignored);
}

/// Interpolation error of objects between ticks, as measured on a catalogue.
void write_interpolation(JsonWriter& json, const Scenario& scenario) {
  const double tick_s = scenario.tick.seconds();
  const auto error = stated_interpolation_error(scenario.interpolation, tick_s);
  json.key("interpolation").begin_object();
  json.field("order", static_cast<int>(scenario.interpolation)).field("tick_s", tick_s);
  if (error) json.field("median_m", error->median_m).field("worst_m", error->worst_m);
  json.end_object();
}

bool is_cueing(const Scenario& scenario) {
  return std::ranges::any_of(scenario.sensors, [](const SensorConfig& s) {
    return std::holds_alternative<PointCued>(s.pointing);
  });
}

}  // namespace

void write_run_record(const RunDirectory& directory, const Scenario& scenario,
                      const RunOutcome& outcome) {
  JsonWriter json;
  json.begin_object().field("status", outcome.status).field("how", outcome.how);
  if (!outcome.reason.empty()) json.field("reason", outcome.reason);
  json.field("software", software_name()).field("digest", directory.digest());
  json.field("seed", scenario.seed).field("wall_s", outcome.wall_s);
  write_interpolation(json, scenario);
  json.key("scenario").raw(physics_json(scenario));
  json.key("nodes").begin_array();
  for (const auto& node : outcome.nodes) {
    json.begin_object().field("name", node.name).field("compute_s", node.compute_s);
    json.field("messaging_s", node.messaging_s).field("waiting_s", node.waiting_s);
    json.field("start_s", node.start_s).field("peak_resident_bytes", node.peak_resident_bytes);
    json.field("private_bytes", node.private_bytes).key("topics").begin_array();
    for (const std::string& topic : node.topics) json.value(topic);
    json.end_array().end_object();
  }
  json.end_array().key("frames").begin_array();
  for (const auto& sensor : scenario.sensors) {
    std::ifstream costs(directory.path() + "/" + sensor.name + "/cost.jsonl");
    std::string line;
    while (std::getline(costs, line))
      if (!costs.eof()) json.raw(line);
  }
  json.end_array().end_object();
  write_file_whole(directory.path() + "/run.json", json.take() + "\n");
}

void write_index_page(const RunDirectory& directory, const Scenario& scenario) {
  std::string html =
      "<!doctype html><meta charset=utf-8><title>DMISE run</title>"
      "<meta name=viewport content='width=device-width'>"
      "<style>body{font:15px/1.4 sans-serif;background:#111;color:#ddd;margin:2em}"
      "a{color:#8cf}img{max-width:100%;background:#000}table{border-collapse:collapse}"
      "td,th{padding:.2em .8em;text-align:right;border-bottom:1px solid #333}"
      "td:first-child,th:first-child{text-align:left}</style>"
      "<h1>DMISE run</h1><p>Start " +
      scenario.start_utc + ", " + std::to_string(static_cast<long>(scenario.duration.seconds())) +
      " s, seed " + std::to_string(scenario.seed) +
      ". Truth is green, streaks found are cyan, points yellow. <a "
      "href=detections.jsonl>detections.jsonl</a> "
      "<a href=truth.jsonl>truth.jsonl</a> " +
      (scenario.fusion ? "<a href=tracks.jsonl>tracks.jsonl</a> " : "") +
      (is_cueing(scenario) ? "<a href=tasks.jsonl>tasks.jsonl</a> " : "") +
      "<a href=run.json>run.json</a></p>"
      "<table><tr><th>sensor<th>frames<th>objects in frame<th>detections<th>s per frame<th>memory, "
      "MB";
  const auto summaries = summarise(scenario, directory.path());
  char cells[256];
  for (const auto& s : summaries) {
    std::snprintf(cells, sizeof cells, "<td>%d<td>%d<td>%d<td>%.2f<td>%.0f", s.frames, s.objects,
                  s.detections, s.seconds_per_frame, s.memory_mb);
    html += "<tr><td><a href='#" + s.name + "'>" + s.name + "</a>" + cells;
  }
  html += "</table>";
  if (write_tracks_figure(scenario, directory.path()))
    html += "<h2>Tracks</h2><p><img src=tracks.svg></p>";
  for (const auto& s : summaries) {
    html += "<h2 id='" + s.name + "'>" + s.name + "</h2>";
    const std::uint32_t last = frames_within(sensor_named(scenario, s.name), scenario.duration);
    for (std::uint32_t frame = 1; frame <= last; ++frame) {
      const std::string base = s.name + "/";
      const std::string marked = base + frame_file_name(frame, "-marked.png");
      if (!exists(directory.path() + "/" + marked)) continue;
      html += "<p>frame " + std::to_string(frame) + ": <a href='" + base +
              frame_file_name(frame, ".fits") + "'>FITS</a> <a href='" + base +
              frame_file_name(frame, ".png") + "'>PNG</a><br><a href='" + marked +
              "'><img loading=lazy src='" + marked + "'></a></p>";
    }
  }
  write_file_whole(directory.path() + "/index.html", html + "\n");
}

bool has_index_page(const RunDirectory& directory) {
  return exists(directory.path() + "/index.html");
}

std::string what_to_open(const RunDirectory& directory, const Scenario& scenario) {
  std::string text;
  for (const auto& sensor : scenario.sensors) {
    const std::string marked =
        directory.path() + "/" + sensor.name + "/" + frame_file_name(1, "-marked.png");
    if (text.empty() && exists(marked)) text = "open " + marked + "\n";
  }
  if (has_index_page(directory))
    text += (text.empty() ? "open " : "or   ") + directory.path() + "/index.html\n";
  return text;
}

std::string summary_text(const RunDirectory& directory, const Scenario& scenario,
                         const RunOutcome& outcome) {
  char row[256];
  std::snprintf(row, sizeof row, "%-20s %7s %8s %11s %11s %10s\n", "sensor", "frames", "objects",
                "detections", "s per frame", "memory, MB");
  std::string text = row;
  for (const auto& s : summarise(scenario, directory.path())) {
    std::snprintf(row, sizeof row, "%-20s %7d %8d %11d %11.2f %10.0f\n", s.name.c_str(), s.frames,
                  s.objects, s.detections, s.seconds_per_frame, s.memory_mb);
    text += row;
  }
  std::snprintf(row, sizeof row, "%s in %.1f s (%s)\n", outcome.status.c_str(), outcome.wall_s,
                outcome.how.c_str());
  text += row;
  return text + what_to_open(directory, scenario);
}

}  // namespace dmise
