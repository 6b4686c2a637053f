#include "launch/tracks_figure.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <map>
#include <set>

#include "core/base/whole_file.h"
#include "core/image/chart.h"
#include "core/score/json_record.h"

namespace dmise {
namespace {

constexpr std::size_t most_lines = 5;  // of a kind
constexpr double least_sigma_m = 0.1, most_sigma_m = 1e5;

struct Line {
  std::uint32_t track = 0;
  bool catalogued = false;
  std::size_t cues = 0;
  std::vector<ChartPoint> points;
};

struct Cue {
  std::uint32_t track = 0;
  ChartBand minutes;
};

const ReadProgress quietly = [](double, const std::string&) {};

double minutes_of(SimTime t) { return t.seconds() / 60; }

std::map<std::uint32_t, Line> lines_of(const std::string& path) {
  std::map<std::uint32_t, Line> lines;
  for_lines(path, quietly, [&](const JsonRecord& record) {
    const Track t = track_of(record);
    Line& line = lines[t.id];
    line.track = t.id;
    line.catalogued = t.catalogue_number != 0;
    const double sigma = std::sqrt(t.covariance[0] + t.covariance[2] + t.covariance[5]);
    if (sigma > 0)
      line.points.push_back({minutes_of(t.time), std::clamp(sigma, least_sigma_m, most_sigma_m)});
  });
  return lines;
}

std::vector<Cue> cues_of(const std::string& path) {
  std::vector<Cue> cues;
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) return cues;
  for_lines(path, quietly, [&](const JsonRecord& record) {
    cues.push_back({record.get<std::uint32_t>("track"),
                    {minutes_of(record.time("on_target_ns")), minutes_of(record.time("end_ns"))}});
  });
  return cues;
}

/// The first few by a number, the largest first; ties by id.
std::vector<const Line*> most(std::vector<const Line*> lines, std::size_t (*number)(const Line&)) {
  std::ranges::stable_sort(lines,
                           [&](const Line* a, const Line* b) { return number(*a) > number(*b); });
  lines.resize(std::min(lines.size(), most_lines));
  return lines;
}

std::vector<ChartTick> minute_ticks(double minutes) {
  double step = 1;
  for (const double s : {1.0, 2.0, 5.0, 10.0, 20.0, 60.0, 120.0, 360.0, 1440.0})
    if (minutes / (step = s) <= 12.5) break;
  std::vector<ChartTick> ticks;
  for (double at = 0; at <= minutes + 1e-9; at += step)
    ticks.push_back({at, std::to_string(long(std::lround(at)))});
  return ticks;
}

}  // namespace

bool write_tracks_figure(const Scenario& scenario, const std::string& directory) {
  std::error_code ignored;
  const std::string path = directory + "/tracks.jsonl";
  if (!scenario.fusion || !std::filesystem::exists(path, ignored)) return false;
  auto lines = lines_of(path);
  const std::vector<Cue> cues = cues_of(directory + "/tasks.jsonl");
  for (const Cue& cue : cues) ++lines[cue.track].cues;
  std::vector<const Line*> unknown, catalogued;
  for (const auto& [id, line] : lines)
    if (line.points.size() > 1) (line.catalogued ? catalogued : unknown).push_back(&line);
  unknown = most(unknown, [](const Line& l) { return l.points.size(); });
  catalogued = most(catalogued, [](const Line& l) { return 1000 * l.cues + l.points.size(); });
  if (unknown.empty() && catalogued.empty()) return false;

  const double minutes = std::max(minutes_of(scenario.duration), 1e-3);
  Chart chart{.title = "How well tracks are known",
              .subtitle =
                  "Standard deviation of the position of tracks in no catalogue, and of "
                  "those of the catalogue that were cued most",
              .x = {.label = "minutes since the start",
                    .least = 0,
                    .most = minutes,
                    .ticks = minute_ticks(minutes)},
              .y = {.label = "m", .logarithmic = true},
              .series = {},
              .bands = {},
              .bands_label = "a telescope observes it"};
  ChartSeries of_catalogue{"in the catalogue", {0, 114, 178}, {}};
  ChartSeries in_none{"in no catalogue", {213, 94, 0}, {}};
  double least = most_sigma_m, greatest = least_sigma_m;
  for (const auto& [from, series] :
       {std::pair(&catalogued, &of_catalogue), std::pair(&unknown, &in_none)})
    for (const Line* line : *from) {
      series->lines.push_back(line->points);
      for (const ChartPoint& p : line->points)
        least = std::min(least, p.y), greatest = std::max(greatest, p.y);
    }
  chart.y.least = std::pow(10, std::floor(std::log10(least)));
  chart.y.most = std::pow(10, std::ceil(std::log10(greatest) + 1e-9));
  chart.y.ticks = logarithmic_ticks(chart.y.least, chart.y.most);
  chart.series = {std::move(of_catalogue), std::move(in_none)};
  std::set<std::uint32_t> marked;
  for (const Line* line : unknown) marked.insert(line->track);
  if (unknown.empty()) marked.insert(catalogued.front()->track);
  for (const Cue& cue : cues)
    if (marked.contains(cue.track)) chart.bands.push_back(cue.minutes);
  write_file_whole(directory + "/tracks.svg", chart_svg(chart));
  return true;
}

}  // namespace dmise
