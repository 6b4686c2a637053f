#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <tuple>

#include "core/base/error.h"
#include "core/base/files/paths.h"
#include "core/base/files/whole_file.h"
#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/base/units.h"
#include "core/config/make_clock.h"
#include "core/sky/places/sun_moon.h"
#include "core/time/iso8601.h"
#include "launch/command/command.h"
#include "launch/command/common_options.h"
#include "launch/command/notes.h"
#include "launch/process/run_lock.h"
#include "launch/run/progress.h"
#include "launch/scenes/pass_list.h"
#include "launch/scenes/range_figure.h"
#include "orbit-node/orbit_actor.h"
#include "sensors/scene/state_window.h"

namespace dmise {
namespace {

struct VisibleOptions {
  std::string scenario, from, out = "out/visible";
  std::vector<std::string> sensors;
  std::optional<double> duration_s;
  double step_s = 10.0;
  bool csv = false, jsonl = false, sunlit = false, dark = false, print_only = false;
  std::optional<double> night_deg;
  int rows = 40;
  int threads = 1;
};

constexpr double max_steps = 5e6;

TimeGrid time_grid(const VisibleOptions& options, const Scenario& scenario, const Clock& clock) {
  SimTime from;
  if (!options.from.empty()) {
    try {
      from = clock.sim_time(parse_utc(options.from));
    } catch (const Error& e) {
      throw ConfigError("--from: " + std::string(e.what()));
    }
  }
  const double duration_s = options.duration_s.value_or(scenario.duration.seconds());
  const double steps = duration_s / options.step_s;
  if (steps > max_steps)
    throw ConfigError("--step: " + std::to_string(std::llround(steps)) +
                      " instants, more than 5000000: use a longer step or a shorter --duration");
  constexpr double longest_s = 9.2e9;  // 64 bits of nanoseconds
  if (from.seconds() + duration_s + options.step_s > longest_s)
    throw ConfigError("--from: the span ends more than 291 years after the scenario's start, got " +
                      printable(options.from));
  for (const SimTime end : {from, from + sim_seconds(duration_s + options.step_s)})
    if (!ephemeris_covers(clock.tt(end)))
      throw ConfigError("--from: the span must be within " + std::to_string(ephemeris_first_year) +
                        " to " + std::to_string(ephemeris_last_year) +
                        ", the years of the ephemeris, got " + format_utc(clock.utc(end), 0));
  return covering_grid(from, sim_seconds(duration_s), sim_seconds(options.step_s));
}

bool wanted(const Pass& pass, const VisibleOptions& options) {
  const double length_s = (pass.set.time - pass.rise.time).seconds();
  if (options.sunlit && !(pass.lit_s > 0.0)) return false;
  if (options.dark && pass.lit_s >= length_s - 2 * event_error_s) return false;
  return !options.night_deg || !pass.top.sun_elevation_rad ||
         pass.min_sun_elevation_rad < *options.night_deg * deg;
}

/// What is said of the passes that are kept.
std::string filters_of(const VisibleOptions& options, const PassList& list) {
  std::string text;
  if (options.sunlit) text += ", sunlit for a part";
  if (options.dark) text += ", dark for a part";
  if (options.night_deg && std::holds_alternative<SiteConfig>(list.sensor.place))
    text += formatted(", the Sun below %g deg for a part", *options.night_deg);
  return text;
}

/// Prints the first few notes; `where`: end of the line about the others.
void print_notes(const std::vector<std::string>& notes, const char* where) {
  constexpr std::size_t most = 5;
  for (std::size_t k = 0; k < std::min(most, notes.size()); ++k) print_note(notes[k]);
  if (notes.size() > most)
    std::fprintf(stderr, "note: and %zu more%s\n", notes.size() - most, where);
}

std::vector<std::string> lost_notes(const Sightings& sightings, const ObjectPopulation& population,
                                    const Clock& clock) {
  std::vector<std::string> notes;
  for (const LostObject& lost : sightings.lost) {
    const MeanElements& e = population.elements[lost.object];
    notes.push_back(std::to_string(e.catalogue_number) + " " + e.name + " has no state from " +
                    format_utc(clock.utc(lost.time), 0) + ": SGP4 code " +
                    std::to_string(int(lost.code)) + ", " + std::string(describe(lost.code)));
  }
  return notes;
}

/// Index of an object that SGP4 propagates.
std::size_t followed(const ObjectPopulation& population, const std::string& name,
                     const std::string& what) {
  const std::size_t i = object_index(population.roster, name, what);
  if (i >= population.elements.size())
    throw ConfigError(what + ": " + name +
                      " has no element set; dmise visible follows objects by SGP4 alone");
  return i;
}

/// A row for each instant of the grid: how many objects are in sight, and how many of them sunlit.
std::string counts_csv(const Sightings& found, const TimeGrid& grid, const Clock& clock) {
  std::vector<std::size_t> in_sight(grid.steps + 1), sunlit(grid.steps + 1);
  for (const Sighting& seen : found.seen) {
    ++in_sight[seen.step];
    sunlit[seen.step] += seen.sunlit >= lit_fraction;
  }
  std::string text = "time_utc,in_sight,sunlit\n";
  for (std::size_t k = 0; k <= grid.steps; ++k)
    text += format_utc(clock.utc(grid.at(k)), 3) + "," + std::to_string(in_sight[k]) + "," +
            std::to_string(sunlit[k]) + "\n";
  return text;
}

void write_products(const std::string& directory, const PassList& list, const std::string& counts,
                    const Chart& chart) {
  make_directories(directory, "--out");
  write_file_whole(directory + "/passes.csv", pass_csv(list));
  write_file_whole(directory + "/passes.jsonl", pass_jsonl(list));
  write_file_whole(directory + "/counts.csv", counts);
  write_file_whole(directory + "/figure.svg", chart_svg(chart));
}

void show_sensor(const SensorConfig& sensor, const VisibleOptions& options,
                 const ObjectPopulation& population, const Sgp4Batch& batch,
                 const EphemerisTable& sky, const TimeGrid& grid, Threads& threads, bool first,
                 bool tells_excluded) {
  std::optional<std::size_t> platform, target;
  if (const auto* p = std::get_if<PlatformConfig>(&sensor.place))
    platform = followed(population, p->object, sensor.name + ": platform");
  if (const auto* p = std::get_if<PointTarget>(&sensor.pointing))
    target = followed(population, p->object, sensor.name + ": pointing.target");
  const SensorTrack track(sensor, sky, batch, platform, target);
  const Clock& clock = sky.clock();

  Progress progress;
  const auto found =
      find_sightings(batch, track, grid, threads, {.progress = [&](double share) {
                       progress.show_share(share, sensor.name + ": looking for objects in sight");
                     }});
  progress.show_share(1.0, sensor.name + ": following passes");
  std::vector<Pass> passes = passes_of(batch, track, found.intervals, threads);
  progress.clear_line();
  std::erase_if(passes, [&](const Pass& p) { return !wanted(p, options); });
  std::ranges::sort(passes, {}, [](const Pass& p) { return std::tuple(p.rise.time, p.object); });
  if (first) print_notes(lost_notes(found, population, clock), " without a state");

  const PassList list{sensor, clock, population.elements, passes, tells_excluded};
  if (options.csv) {
    std::fputs(pass_csv(list, first).c_str(), stdout);
  } else if (options.jsonl) {
    std::fputs(pass_jsonl(list).c_str(), stdout);
  } else {
    std::set<std::uint32_t> objects;
    for (const Pass& p : passes) objects.insert(p.object);
    const std::string from = format_utc(clock.utc(grid.from), 3),
                      to = format_utc(clock.utc(grid.last()), 3);
    const bool whole_s = from.ends_with(".000Z") && to.ends_with(".000Z");
    const std::size_t length = from.size() - (whole_s ? 5 : 1);
    std::printf("%s%s, %sZ to %sZ: %s of %s%s\n", first ? "" : "\n", sensor.name.c_str(),
                from.substr(0, length).c_str(), to.substr(0, length).c_str(),
                counted(passes.size(), "pass", "passes").c_str(),
                counted(objects.size(), "object").c_str(), filters_of(options, list).c_str());
    std::fputs(pass_table(list, options.rows, !options.print_only).c_str(), stdout);
  }
  if (options.print_only) return;
  RangeFigureOptions figure{.dark = options.dark};
  if (options.night_deg) figure.night_below_rad = *options.night_deg * deg;
  const std::string directory = options.out + "/" + sensor.name;
  write_products(directory, list, counts_csv(found, grid, clock),
                 range_figure(track, grid, population.elements, found, figure));
  if (!options.csv && !options.jsonl)
    std::printf("-> %s/passes.csv, passes.jsonl, counts.csv, figure.svg\n", directory.c_str());
}

void visible(const VisibleOptions& options) {
  Scenario scenario = load_scenario(options.scenario);
  keep_cameras(scenario, "dmise visible");
  std::vector<const SensorConfig*> sensors;
  for (const std::string& name : options.sensors) sensors.push_back(&sensor_named(scenario, name));
  for (auto name = options.sensors.begin(); name != options.sensors.end(); ++name)
    if (std::find(options.sensors.begin(), name, *name) != name)
      throw ConfigError("--sensor: " + printable(*name) + " is there twice");
  if (sensors.empty())
    for (const SensorConfig& sensor : scenario.sensors) sensors.push_back(&sensor);
  const Clock clock = make_clock(scenario);
  const TimeGrid grid = time_grid(options, scenario, clock);
  const ObjectPopulation population = load_objects(scenario, clock);
  print_notes(population.notes, "; dmise check lists all");
  if (const std::size_t others = population.roster.objects.size() - population.elements.size())
    std::fprintf(stderr, "note: %zu of %zu objects are left out: no element sets\n", others,
                 population.roster.objects.size());
  Threads threads(options.threads);
  const Sgp4Batch batch(population.elements, &threads);
  const EphemerisTable sky(clock, grid.from, grid.last(), scenario.earth.ellipsoid);
  std::unique_ptr<RunLock> lock;
  if (!options.print_only) lock = lock_directory(options.out);
  const bool tells_excluded = std::ranges::any_of(
      sensors, [](const SensorConfig* sensor) { return sensor->camera.exclusion.any(); });
  bool first = true;
  for (const SensorConfig* sensor : sensors) {
    show_sensor(*sensor, options, population, batch, sky, grid, threads, first, tells_excluded);
    first = false;
  }
}

void add_visible_options(CLI::App& command) {
  auto o = std::make_shared<VisibleOptions>();
  command.add_option("scenario", o->scenario, "scenario (YAML)")->required();
  command.add_option("--sensor", o->sensors, "only this sensor (may be repeated)")
      ->allow_extra_args(false);
  command.add_option("--from", o->from, "UTC (ISO 8601); default: the scenario's start");
  command.add_option("--duration", o->duration_s, "seconds; default: the scenario's")
      ->check(number_between(1e-3, 3.2e8));
  add_number_option(command, "--step", o->step_s, 1e-3, 3600.0,
                    "seconds between the instants of the figure, the last of them the span's end; "
                    "passes do not depend on it");
  auto* sunlit = command.add_flag("--sunlit", o->sunlit, "only passes that are partly sunlit");
  command
      .add_flag("--dark", o->dark,
                "only passes that are partly in the Earth's shadow; the figure shows that part")
      ->excludes(sunlit);
  command
      .add_option("--night", o->night_deg,
                  "only passes during which, for a part, the Sun is below this elevation at the "
                  "site [deg]; -6 without a value; passes in orbit are all kept")
      ->expected(0, 1)
      ->default_str("-6")
      ->check(number_between(-90.0, 90.0));
  command.add_option("--rows", o->rows, "number of passes in the table; 0: all")
      ->check(CLI::Range(0, 1'000'000'000))
      ->capture_default_str();
  auto* csv = command.add_flag("--csv", o->csv, "print CSV instead of the table");
  command.add_flag("--jsonl", o->jsonl, "print one JSON object per line instead of the table")
      ->excludes(csv);
  command
      .add_option("--out", o->out,
                  "directory of passes.csv, passes.jsonl, counts.csv, figure.svg and .png")
      ->capture_default_str();
  command.add_flag("--print-only", o->print_only, "write no files");
  add_threads_option(command, o->threads, "number of threads; the products do not depend on it");
  command.footer(
      "An object is visible if it is in the camera's frame, above the sensor's mask_deg and "
      "not behind\nthe Earth, and the shutter is open; '<' and '>' mark passes cut by the span. "
      "docs/models/visibility.md");
  command.callback([o] { visible(*o); });
}

}  // namespace

Command visible_command() {
  return {
      .group = CommandGroup::predictions,
      .summary = "Lists passes of objects through the sensors' fields: times, ranges, illumination",
      .add_options = add_visible_options};
}

}  // namespace dmise
