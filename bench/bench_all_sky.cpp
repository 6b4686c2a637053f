#include "bench/bench_all_sky.h"

#include <malloc.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

#include "bench/catalogue_file.h"
#include "bench/effect_shares.h"
#include "bench/figure.h"
#include "bench/status_memory.h"
#include "bench/timing.h"
#include "core/base/files/text_file.h"
#include "core/base/units.h"
#include "core/config/make_clock.h"
#include "core/config/sensors/effect_list.h"
#include "core/config/yaml/search_path.h"
#include "core/effects/frame_effects.h"
#include "core/image/fits_file.h"
#include "orbit-node/load_objects.h"
#include "sensors/frame/make_sensor.h"
#include "sensors/objects/state_window_source.h"

namespace dmise {
namespace {

constexpr int all_sky_repeats = 7;

double wall_s() {
  const auto now = std::chrono::steady_clock::now().time_since_epoch();
  return std::chrono::duration<double>(now).count();
}

template <class T>
T median(std::vector<T> values) {
  std::nth_element(values.begin(), values.begin() + std::ptrdiff_t(values.size() / 2),
                   values.end());
  return values[values.size() / 2];
}

std::string scenario_text(const WrittenCatalogue& catalogue, const std::string& name,
                          const std::string& stars = "{catalogue: kstars, faintest_mag: 9}") {
  return "simulation: {start: " + catalogue.start_utc +
         ", duration_s: 20, tick_s: 5}\n"
         "objects: [{catalogue: " +
         catalogue.path +
         "}]\n"
         "stars: " +
         stars +
         "\n"
         "detection: off\n"
         "sensors:\n  - {name: " +
         name +
         ", site: atlanta, camera: omnissa, pointing: zenith, exposure_s: 20, cadence_s: 20, sky: "
         "dark}\n";
}

/// Inputs of a sensor from other nodes over the exposure, computed before it starts.
StateWindow window_of(const Scenario& scenario, Threads& threads) {
  const Clock clock = make_clock(scenario);
  const ObjectPopulation population = load_objects(scenario, clock);
  const StateSource states(population, clock, threads);
  const SensorConfig& sensor = scenario.sensors[0];
  return StateWindowSource(scenario, sensor, clock)
      .until(frame_times(sensor, 1), population, states);
}

/// Peak memory of this process [MB] while `work` runs, as reported by the kernel. Pages of
/// libraries count fully: their share (PSS) depends on other processes of the machine. Code that
/// other nodes run, such as SGP4, does not count.
template <class Work>
double peak_mb(const Work& work) {
  forget_code();
  std::ofstream("/proc/self/clear_refs") << "5";  // proc(5): resets the peak
  work();
  return status_mb("VmHWM");
}

struct Measured {
  std::vector<double> cpu_s, wall_s, writing_s;
  std::vector<EffectTimes> effects;
};

/// Stages are timed by the wall clock: those of the frame that was least disturbed.
void print_stages(const Measured& m, bool json) {
  const auto best =
      std::size_t(std::min_element(m.wall_s.begin(), m.wall_s.end()) - m.wall_s.begin());
  const double total_s = m.wall_s[best];
  double rest_s = total_s;
  const auto print = [&](const std::string& stage, double seconds) {
    rest_s -= seconds;
    print_figure(
        {"all_sky_" + stage + "_ms", 1e3 * seconds, "ms", "whole frame [ms]", 1e3 * total_s}, json);
  };
  for (const EffectFacts* effect : all_effects())
    if (const double s = m.effects[best][*effect]; s > 0.0) print(std::string(effect->name), s);
  print("fits", m.writing_s[best]);
  print("rest", std::max(0.0, rest_s));
}

/// Prints parts that are interleaved with others in a frame, measured separately.
void print_shares(const Scenario& scenario, const FrameTimes& exposure, const StateWindow& window,
                  const Measured& m, std::size_t star_places, bool json) {
  const auto best =
      std::size_t(std::min_element(m.wall_s.begin(), m.wall_s.end()) - m.wall_s.begin());
  const View view(scenario.sensors[0], exposure, window);
  const auto map = load_stars(scenario);
  const EffectTimes& spent = m.effects[best];
  const EffectTimes shares =
      effect_shares(view, map->stars, star_places, spent[SkyBackground::facts]);
  for (const auto& [effect, seconds] : shares.seconds)
    print_figure({"all_sky_" + std::string(effect) + "_ms", 1e3 * seconds, "ms"}, json);
}

/// One sensor's frames and what it needs for them.
struct AllSky {
  AllSky(const std::string& path, Threads& threads)
      : scenario(load_scenario(path)),
        window(window_of(scenario, threads)),
        pipeline({.sensor = scenario.sensors[0],
                  .clock = make_clock(scenario),
                  .seed = 1,
                  .digest = "bench",
                  .faintest_star_mag = scenario.faintest_star_mag},
                 load_stars(scenario), threads) {}
  /// Makes a frame; processor seconds.
  double make() {
    const double before = thread_seconds();
    stars = pipeline.run(frame_times(scenario.sensors[0], 1), window).report.stars_rendered;
    return thread_seconds() - before;
  }
  Scenario scenario;
  StateWindow window;
  FramePipeline pipeline;
  std::uint32_t stars = 0;
};

/// The frame with all of Tycho-2 beside that with stars.dat, by turns; and the private memory that
/// the catalogue takes of a process.
void measure_tycho2(const std::filesystem::path& directory, bool json) {
  if (find_catalogue("tycho2.stars").empty()) {
    std::fprintf(stderr, "bench all-sky: no tycho2.stars: the frame with it is skipped\n");
    return;
  }
  Threads one(1);
  const WrittenCatalogue objects = catalogue_of_18470(directory);
  const auto sky_of = [&](const std::string& name, const std::string& stars) {
    const std::string path = (directory / (name + ".yaml")).string();
    std::ofstream(path) << scenario_text(objects, name, stars);
    return AllSky(path, one);
  };
  AllSky bright = sky_of("bright", "{catalogue: kstars, faintest_mag: 30}");
  AllSky deep = sky_of("deep", "{catalogue: tycho2, faintest_mag: 30}");
  std::vector<double> bright_s, deep_s, ratio;
  for (int i = 0; i < all_sky_repeats; ++i) {
    bright_s.push_back(bright.make());
    deep_s.push_back(deep.make());
    ratio.push_back(deep_s.back() / bright_s.back());
  }
  print_figure({"all_sky_kstars_all_stars", double(bright.stars), "1"}, json);
  print_figure({"all_sky_tycho2_stars", double(deep.stars), "1"}, json);
  print_figure({"all_sky_tycho2_s", median(deep_s), "s", "with stars.dat [s]", median(bright_s)},
               json);
  print_figure({"all_sky_tycho2_ratio", median(ratio), "1", "", 0, 1.6, true}, json);
  malloc_trim(0);
  const double before_mb = status_mb("RssAnon");
  const auto map = load_star_map(find_catalogue("tycho2.stars"));
  std::vector<std::uint32_t> found;
  query_cone(map, {0, 0, 1}, 0.5 * deg, 99.0, found);
  print_figure(
      {"tycho2_private_mb", std::max(0.0, status_mb("RssAnon") - before_mb), "MB", "", 0, 20, true},
      json);
}

}  // namespace

std::string all_sky_scenario(const std::filesystem::path& directory) {
  if (find_catalogue("stars.dat.gz").empty()) return "";
  const std::string path = (directory / "all-sky.yaml").string();
  std::ofstream(path) << scenario_text(catalogue_of_18470(directory), "all-sky");
  return path;
}

void measure_all_sky(bool json) {
  const auto directory =
      std::filesystem::temp_directory_path() / ("dmise-bench-" + std::to_string(getpid()));
  std::filesystem::create_directories(directory);
  const std::string path = all_sky_scenario(directory);
  if (path.empty()) return;
  {
    Threads one(1);
    AllSky sky(path, one);
    const Scenario& scenario = sky.scenario;
    malloc_trim(0);
    print_figure({"all_sky_resting_mb", status_mb("VmRSS"), "MB"},
                 json);  // states, stars, programs
    const FrameTimes exposure = frame_times(scenario.sensors[0], 1);
    const std::string fits = (directory / "frame.fits").string();
    Measured measured;
    std::uint32_t stars = 0, objects = 0;
    const auto make = [&] {
      const double cpu = thread_seconds(), wall = wall_s();
      const FrameProducts frame = sky.pipeline.run(exposure, sky.window);
      const double writing = thread_seconds();
      write_frame(fits, frame.counts, frame.header);
      measured.writing_s.push_back(thread_seconds() - writing);
      measured.cpu_s.push_back(thread_seconds() - cpu);
      measured.wall_s.push_back(wall_s() - wall);
      measured.effects.push_back(frame.times);
      stars = frame.report.stars_rendered;
      objects = frame.report.objects_rendered;
    };
    for (int i = 0; i < all_sky_repeats; ++i) make();
    const double s = median(measured.cpu_s);
    print_figure({"all_sky_s", s, "s", "", 0, 0.18, true}, json);
    print_figure({"all_sky_wall_s", median(measured.wall_s), "s"}, json);
    print_stages(measured, json);
    print_figure({"all_sky_stars", double(stars), "1"}, json);
    print_figure({"all_sky_objects", double(objects), "1"}, json);
    print_figure({"all_sky_peak_mb", peak_mb([&] {
                    make();
                    make();
                  }),
                  "MB", "", 0, 80, true},
                 json);
    print_shares(scenario, exposure, sky.window, measured, 3 * std::size_t(stars), json);
  }
  measure_tycho2(directory, json);
  std::filesystem::remove_all(directory);
}

}  // namespace dmise
