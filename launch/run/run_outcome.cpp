#include "launch/run/run_outcome.h"

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/files/paths.h"
#include "core/base/files/whole_file.h"
#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/base/version.h"
#include "core/orbit/interpolation_error.h"
#include "core/products/frame_file.h"
#include "core/run/run_files.h"
#include "launch/command/notes.h"
#include "launch/run/write_report.h"

namespace dmise {
namespace {

/// Interpolation error of objects between ticks, as measured on a catalogue.
void write_interpolation(JsonWriter& json, const Scenario& scenario) {
  const double tick_s = scenario.tick.seconds();
  const auto error = stated_interpolation_error(scenario.interpolation, tick_s);
  json.key("interpolation").begin_object();
  json.field("order", static_cast<int>(scenario.interpolation)).field("tick_s", tick_s);
  if (error) json.field("median_m", error->median_m).field("worst_m", error->worst_m);
  json.end_object();
}

}  // namespace

void write_run_record(const RunDirectory& directory, const Scenario& scenario,
                      const RunOutcome& outcome) {
  JsonWriter json;
  json.begin_object().field("status", outcome.status).field("how", outcome.how);
  if (!outcome.reason.empty()) json.field("reason", outcome.reason);
  json.list("dropped", outcome.dropped);
  json.field("software", software_name()).field("digest", directory.digest());
  json.field("seed", scenario.seed).field("wall_s", outcome.wall_s);
  json.field("parts", outcome.parts);
  json.list("catalogue_sha256", directory.catalogue_sha256());
  write_interpolation(json, scenario);
  json.end_object();
  // The summary in the first line, then what grows with the run: a line a node and a frame.
  std::string text = json.take();
  text.pop_back();
  text += ",\n\"scenario\":" + physics_json(scenario) + ",\n\"nodes\":[";
  const char* separator = "\n";
  for (const auto& node : outcome.nodes) {
    const TimeSplit& times = node.times;
    JsonWriter line;
    line.begin_object().field("name", node.name).field("compute_s", times.compute_s);
    line.field("messaging_s", times.messaging_s).field("waiting_s", times.waiting_s);
    line.field("start_s", times.start_s).field("peak_resident_bytes", times.peak_resident_bytes);
    line.field("private_bytes", times.private_bytes).list("topics", node.consumes).end_object();
    text += separator + line.take();
    separator = ",\n";
  }
  text += "],\n\"frames\":[";
  separator = "\n";
  for (const auto& sensor : scenario.sensors)
    for (const auto& line :
         whole_lines(path_in(directory.path() + "/" + sensor.name, run_file::costs))) {
      text += separator + line;
      separator = ",\n";
    }
  write_file_whole(path_in(directory.path(), run_file::record), text + "]}\n");
}

void write_index_page(const RunDirectory& directory, bool pixels) {
  try {
    write_report(directory.path(), pixels);
  } catch (const Error& error) {
    print_note(path_in(directory.path(), run_file::page) + " was not written: " + error.what());
  }
}

bool has_index_page(const RunDirectory& directory) {
  return path_exists(path_in(directory.path(), run_file::page));
}

std::string what_to_open(const RunDirectory& directory, const Scenario& scenario) {
  std::string text;
  for (const auto& sensor : scenario.sensors) {
    const std::string marked =
        directory.path() + "/" + sensor.name + "/" + frame_file_name(1, "-marked.png");
    if (text.empty() && path_exists(marked)) text = "open " + marked + "\n";
  }
  if (has_index_page(directory))
    text += (text.empty() ? "open " : "or   ") + path_in(directory.path(), run_file::page) + "\n";
  return text;
}

std::string summary_text(const RunDirectory& directory, const Scenario& scenario,
                         const RunOutcome& outcome) {
  std::string text = formatted("%-20s %7s %8s %11s %11s %10s\n", "sensor", "frames", "objects",
                               "detections", "s per frame", "memory, MB");
  for (const auto& s : summarise(scenario, directory.path()))
    text += formatted("%-20s %7d %8d %11d %11.2f %10.0f\n", s.name.c_str(), s.frames, s.objects,
                      s.detections, s.seconds_per_frame, s.memory_mb);
  text +=
      formatted("%s in %.1f s (%s)", outcome.status.c_str(), outcome.wall_s, outcome.how.c_str());
  if (outcome.parts > 1) text += formatted(" and %d parts", outcome.parts);
  if (outcome.status != "failed" && !outcome.reason.empty())
    text += ": " + printable(outcome.reason, 400);
  text += '\n';
  return text + what_to_open(directory, scenario);
}

}  // namespace dmise
