#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <sstream>
#include <string>
#include <vector>

#include "core/base/error.h"
#include "core/base/files/json.h"
#include "core/base/files/paths.h"
#include "core/base/files/text_file.h"
#include "core/base/files/whole_file.h"
#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/base/version.h"
#include "core/image/charts/chart.h"
#include "launch/command/command.h"
#include "launch/command/notes.h"
#include "launch/process/run_lock.h"
#include "launch/run/progress.h"
#include "launch/run/run_directory.h"
#include "sensors/accuracy/tradeoff.h"

namespace dmise {
namespace {

constexpr Colour colours[] = {{31, 119, 180},  {255, 127, 14}, {44, 160, 44},   {214, 39, 40},
                              {148, 103, 189}, {140, 86, 75},  {227, 119, 194}, {127, 127, 127},
                              {188, 189, 34},  {23, 190, 207}};
constexpr double min_error = 1e-6;  // drawn for none

double in_budgets(const ErrorBound& error) {
  double largest = 0.0;
  for (const auto& kind : error_kinds)
    largest = std::max(largest, error.*kind.value / standard_budget.*kind.value);
  return largest;
}

/// A logarithmic axis that holds all values.
ChartAxis axis(const std::string& label, std::vector<double> values) {
  const auto [least, most] = std::ranges::minmax_element(values);
  if (values.empty()) return logarithmic_axis(label, 0.1, 1.0);
  return logarithmic_axis(label, 0.8 * *least, 1.25 * *most);
}

/// A small cross, as lines of a series.
void add_mark(ChartSeries& series, ChartPoint at) {
  series.lines.push_back({{at.x * 0.99, at.y}, {at.x * 1.01, at.y}});
  series.lines.push_back({{at.x, at.y * 0.9}, {at.x, at.y * 1.1}});
}

std::string number(double value) { return std::isnan(value) ? "-" : formatted("%.3g", value); }

/// JSON has neither NaN nor infinity.
std::optional<double> finite(double value) {
  return std::isfinite(value) ? std::optional(value) : std::nullopt;
}

/// Error against time: a line for each effect, with its levels as points.
Chart effects_chart(const std::vector<TradeoffRow>& rows, const ErrorKind& kind) {
  Chart chart{.title = std::string("One effect at a time: ") + kind.key,
              .subtitle = "time of the frame over the reference's, at each level"};
  std::map<std::string, std::vector<ChartPoint>> lines;
  std::vector<double> xs{1.0}, ys{min_error};
  for (const auto& row : rows) {
    if (row.effect == "budget" || !(row.measured.*kind.value > min_error)) continue;
    const ChartPoint at{row.seconds / row.reference_s, row.measured.*kind.value};
    lines[row.effect].push_back(at);
    xs.push_back(at.x);
    ys.push_back(at.y);
  }
  std::size_t colour = 0;
  for (auto& [effect, points] : lines) {
    ChartSeries series{.label = effect, .colour = colours[colour++ % std::size(colours)]};
    series.lines.push_back(points);
    for (const auto& point : points) add_mark(series, point);
    chart.series.push_back(std::move(series));
  }
  chart.x = axis("time / reference", xs);
  chart.y = axis(std::string(kind.key) + " [" + kind.unit + "]", ys);
  return chart;
}

/// Largest error, in standard budgets, against time of planned frames.
Chart budgets_chart(const std::vector<TradeoffRow>& rows) {
  Chart chart{.title = "Planned frames",
              .subtitle = "largest error of a frame, in standard budgets; the cross is standard"};
  ChartSeries measured{.label = "measured", .colour = colours[0]};
  ChartSeries bound{.label = "bound", .colour = colours[1]};
  ChartSeries standard{.label = "standard", .colour = colours[3]};
  std::vector<ChartPoint> measured_at, bound_at;
  std::vector<double> xs, ys;
  for (const auto& row : rows) {
    if (row.effect != "budget") continue;
    const ChartPoint at{row.seconds, std::max(min_error, in_budgets(row.measured))};
    const ChartPoint limit{row.seconds, std::max(min_error, in_budgets(row.bound))};
    measured_at.push_back(at);
    bound_at.push_back(limit);
    add_mark(measured, at);
    add_mark(bound, limit);
    if (row.level == "standard") add_mark(standard, at);
    xs.push_back(row.seconds);
    ys.insert(ys.end(), {at.y, limit.y});
  }
  for (auto* points : {&measured_at, &bound_at}) std::ranges::sort(*points, {}, &ChartPoint::x);
  measured.lines.push_back(measured_at);
  bound.lines.push_back(bound_at);
  chart.series = {measured, bound, standard};
  chart.x = axis("time of a frame [s]", xs);
  chart.y = axis("error / standard budget", ys);
  return chart;
}

/// One page without anything from elsewhere: charts and the table of all rows.
std::string tradeoff_page(const std::string& title, const std::vector<TradeoffRow>& rows) {
  std::string page =
      "<!doctype html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>What accuracy "
      "costs</title>\n<style>body{font:15px sans-serif;margin:2em;max-width:1450px}table{border-"
      "collapse:collapse}td,th{padding:2px 10px;text-align:right;border-bottom:1px solid "
      "#ddd}td:nth-child(-n+2){text-align:left}svg{max-width:100%;height:auto}</style></head>\n"
      "<body><h1>What accuracy costs</h1><p>" +
      title + "</p>\n" + chart_svg(budgets_chart(rows));
  for (const auto& kind : error_kinds) page += "\n" + chart_svg(effects_chart(rows, kind));
  page +=
      "\n<p>Errors: measured / bound; -: nothing in the frame can show "
      "it.</p><table><tr><th>effect</th><th>level</th>";
  for (const auto& kind : error_kinds)
    page += std::string("<th>") + kind.key + " [" + kind.unit + "]</th>";
  page +=
      "<th>rms residual [sigma]</th><th>detected</th><th>time [s]</th><th>reference [s]</th>"
      "</tr>\n";
  for (const auto& row : rows) {
    page += "<tr><td>" + row.effect + "</td><td>" + row.level + "</td>";
    for (const auto& kind : error_kinds)
      page += "<td>" + number(row.measured.*kind.value) + " / " + number(row.bound.*kind.value) +
              "</td>";
    for (const double value : {row.residual_sigma, row.detected, row.seconds, row.reference_s})
      page += "<td>" + number(value) + "</td>";
    page += "</tr>\n";
  }
  return page + "</table></body></html>\n";
}

std::string tradeoff_json(const std::string& digest, const std::vector<TradeoffRow>& rows) {
  JsonWriter json;
  json.begin_object().field("digest", digest).key("rows").begin_array();
  for (const auto& row : rows) {
    json.begin_object().field("effect", row.effect).field("level", row.level);
    for (const auto& [key, error] : {std::pair{"bound", row.bound}, {"measured", row.measured}}) {
      json.key(key).begin_object();
      for (const auto& kind : error_kinds) json.field(kind.key, finite(error.*kind.value));
      json.end_object();
    }
    json.field("residual_sigma", row.residual_sigma).field("detected", finite(row.detected));
    json.field("seconds", row.seconds).field("reference_s", row.reference_s).end_object();
  }
  return json.end_array().end_object().take() + "\n";
}

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
