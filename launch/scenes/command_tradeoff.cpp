#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <sstream>
#include <vector>

#include "core/base/error.h"
#include "core/base/files/paths.h"
#include "core/base/files/text_file.h"
#include "core/base/files/whole_file.h"
#include "core/base/printable.h"
#include "core/base/version.h"
#include "launch/command/command.h"
#include "launch/command/notes.h"
#include "launch/process/run_lock.h"
#include "launch/run/progress.h"
#include "launch/run/run_directory.h"
#include "launch/scenes/tradeoff_page.h"

namespace dmise {
namespace {

struct TradeoffOptions {
  std::string scenario, sensor, out = "out/tradeoff";
  unsigned frame = 1;
  int repeats = 3;
};

/// The rows of an earlier call with the same `head`, the file's first line.
std::vector<TradeoffRow> known_rows(const std::string& path, const std::string& head) {
  std::vector<TradeoffRow> rows;
  if (!path_exists(path)) return rows;
  std::istringstream lines(read_text_file(path, 1u << 26));
  std::string line;
  if (!std::getline(lines, line) || line != head) {
    print_note(path + ": is replaced: it is of another measurement, " + printable(line));
    return rows;
  }
  while (std::getline(lines, line))
    if (auto row = row_of_csv(line)) rows.push_back(std::move(*row));
  return rows;
}

void tradeoff(const TradeoffOptions& options) {
  const Scenario scenario = load_scenario(options.scenario);
  refuse_own_nodes(scenario.own_nodes, "dmise tradeoff");
  const std::string sensor =
      options.sensor.empty() ? scenario.sensors.front().name : options.sensor;
  sensor_named(scenario, sensor);
  make_directories(options.out, "--out");
  const auto lock = lock_directory(options.out);
  const std::string digest = scenario_digest(scenario);
  const std::string head = "# " + software_name() + " tradeoff " + digest + " " + sensor +
                           " frame " + std::to_string(options.frame) + " repeats " +
                           std::to_string(options.repeats);
  const std::string csv = options.out + "/tradeoff.csv";
  Progress progress;
  Threads one(1);
  const SceneFrames scene(scenario, sensor, options.frame, one);
  const Tradeoff trade(scene, options.repeats);
  auto rows = known_rows(csv, head);
  const auto save = [&] {
    std::string text = head + "\n" + tradeoff_csv_header() + "\n";
    for (const auto& row : rows) text += csv_line(row) + "\n";
    write_file_whole(csv, text);
  };
  for (std::size_t i = 0; i < trade.rows().size(); ++i) {
    const TradeoffRow& wanted = trade.rows()[i];
    progress.show_share(double(i) / double(trade.rows().size()),
                        "tradeoff: " + wanted.effect + " " + wanted.level);
    if (std::ranges::any_of(rows, [&](const TradeoffRow& row) {
          return row.effect == wanted.effect && row.level == wanted.level;
        }))
      continue;
    rows.push_back(trade.measure(i));
    save();
  }
  progress.clear_line();
  write_file_whole(options.out + "/tradeoff.json", tradeoff_json(digest, rows));
  write_file_whole(options.out + "/index.html",
                   tradeoff_page(printable(scenario.path) + ", sensor " + sensor + ", frame " +
                                     std::to_string(options.frame),
                                 rows));
  write_file_whole(options.out + "/budgets.svg", chart_svg(budgets_chart(rows)));
  for (const auto& kind : error_kinds)
    write_file_whole(options.out + "/" + kind.key + ".svg", chart_svg(effects_chart(rows, kind)));
  for (const auto& note : trade.notes()) print_note(note);
  std::printf("%s/index.html: %zu rows\n", options.out.c_str(), rows.size());
}

void add_tradeoff_options(CLI::App& command) {
  auto options = std::make_shared<TradeoffOptions>();
  command.add_option("scenario", options->scenario, "scenario (YAML)")->required();
  command.add_option("--sensor", options->sensor,
                     "name of the sensor; default: the first of the scenario");
  command.add_option("--frame", options->frame, "number of the exposure")
      ->default_val(1)
      ->check(CLI::Range(1u, 1000000u));
  command.add_option("--repeats", options->repeats, "frames of each kind that are timed, in turns")
      ->default_val(3)
      ->check(CLI::Range(1, 1000));
  command.add_option("--out", options->out, "directory of the products")
      ->default_val("out/tradeoff");
  command.callback([options] { tradeoff(*options); });
}

}  // namespace

Command tradeoff_command() {
  return {.group = CommandGroup::accuracy,
          .summary =
              "Measures what levels of effects cost and lack, against the reference of one frame",
          .details =
              "Of each level of each effect, and of plans for a set of budgets; CSV, JSON, charts "
              "and a page. Goes on where it was stopped",
          .add_options = add_tradeoff_options};
}

}  // namespace dmise
