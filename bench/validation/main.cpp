#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "bench/figure.h"
#include "bench/validation/brightness.h"
#include "bench/validation/detector_figures.h"
#include "bench/validation/drawn_frames.h"
#include "bench/validation/real_frames.h"
#include "bench/validation/sky_brightness.h"
#include "bench/validation/validation_page.h"
#include "core/base/error.h"
#include "core/base/files/paths.h"
#include "core/base/files/text_file.h"
#include "core/base/files/whole_file.h"
#include "core/config/yaml/search_path.h"
#include "nodes/runtime/program/command_line.h"
#include "nodes/runtime/program/version_text.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t drawn_frames = 60;  // frames of each sensor
constexpr std::uint64_t drawn_seed = 1;

struct Options {
  std::vector<std::string> names;
  std::string data, page, csv;
  std::size_t every = 1;
  bool json = false;
};

std::string data_of(const Options& options) {
  if (!options.data.empty()) return options.data;
  if (const char* data = std::getenv("DMISE_DATA")) return std::string(data) + "/validation";
  return home_directory() + "/../shared/data/validation";
}

bool wanted(const Options& options, const char* name) {
  return options.names.empty() || std::ranges::find(options.names, name) != options.names.end();
}

/// Whether a wanted part reads measurements.
bool needs_data(const Options& options) {
  return std::ranges::any_of(std::array{"brightness", "places", "frames"},
                             [&](const char* name) { return wanted(options, name); });
}

/// The script of places, in a source tree or where it is installed.
std::string places_script() {
  for (const char* folder : {"/bench/validation", "/validation"})
    if (const std::string path = home_directory() + folder + "/places.py"; path_exists(path))
      return path;
  throw ConfigError(home_directory() + ": there is no validation/places.py; DMISE_HOME is wrong");
}

void run_program(std::vector<std::string> words) {
  std::vector<char*> arguments;
  for (auto& word : words) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  std::fflush(stdout);
  pid_t pid = 0;
  if (posix_spawnp(&pid, arguments[0], nullptr, nullptr, arguments.data(), environ) != 0)
    throw Error(words[0] + ": can't be started");
  int status = 0;
  while (waitpid(pid, &status, 0) < 0 && errno == EINTR) {
  }
  if (status != 0) throw Error(words[1] + ": failed");
}

/// Prints the figures of places; returns their section of the page.
std::string compare_places(const Options& options, const std::string& data) {
  const fs::path section =
      fs::temp_directory_path() / ("dmise-validate-" + std::to_string(getpid()) + ".md");
  const fs::path dmise = fs::read_symlink("/proc/self/exe").parent_path() / "dmise";
  const char* debian = "/usr/bin/python3";  // has python3-erfa, python3-numpy and python3-sgp4
  std::vector<std::string> words{path_exists(debian) ? debian : "python3",
                                 places_script(),
                                 dmise.string(),
                                 data,
                                 "--every",
                                 std::to_string(options.every),
                                 "--section",
                                 section.string()};
  if (options.json) words.push_back("--json");
  run_program(std::move(words));
  const std::string text = read_text_file(section.string());
  remove_file(section.string());
  return text;
}

/// docs/validation.md of a source tree, else validation.md.
std::string page_of(const Options& options) {
  if (!options.page.empty() || options.json || !options.names.empty()) return options.page;
  return fs::is_directory("docs") ? "docs/validation.md" : "validation.md";
}

void print_half(const std::string& name, const BrightnessFigures& f, const FamilyBrightness& family,
                bool judged, bool json) {
  const auto print = [&](const char* what, double value, double anchor, double target) {
    print_figure({.name = name + what,
                  .value = value,
                  .unit = "mag",
                  .anchor = anchor > 0.0 ? "a phase law" : "",
                  .anchor_value = anchor,
                  .target = judged ? target : 0.0,
                  .less_is_better = true},
                 json);
  };
  print("_median", f.median_mag, 0.0, 0.0);
  print("_mean", f.mean_mag, 0.0, 0.0);
  print("_median_off", std::abs(f.median_mag), 0.0, family.target_median_mag);
  print("_scatter", f.scatter_mag, f.phase_law_scatter_mag, family.target_scatter_mag);
  print("_between_tracks", f.track_scatter_mag, 0.0, 0.0);
  if (f.within_measured_mag == 0.0) return;
  print("_within_measured", f.within_measured_mag, 0.0, 0.0);
  print("_within_model", f.within_predicted_mag, 0.0, 0.0);
  print("_within_difference", f.within_difference_mag, 0.0, 0.0);
}

/// Prints the ratios of the model's power of light curves to the measured.
void print_power(const std::string& name, const CurvePower& power, bool json) {
  for (const auto& band : power.bands) {
    const std::string periods =
        band.longest_s > 0.0 ? std::to_string(int(band.shortest_s)) + "s" : std::string("all");
    const auto print = [&](const char* what, double model, double measured) {
      print_figure({.name = name + "_power_" + periods + what,
                    .value = model / measured,
                    .unit = "of the measured",
                    .anchor = {},
                    .less_is_better = false},
                   json);
    };
    print("_mean", band.model_mean, band.measured_mean);
    print("_median", band.model_median, band.measured_median);
  }
}

/// Prints by which factor the power of all periods is off.
void print_power_off(const std::string& name, const CurvePower& power, bool json) {
  if (power.bands.empty()) return;
  const auto print = [&](const char* what, double model, double measured) {
    print_figure({.name = name + what,
                  .value = std::max(model / measured, measured / model),
                  .unit = "times",
                  .anchor = {},
                  .target = power_target,
                  .less_is_better = true},
                 json);
  };
  const CurveBand& all = power.bands.back();
  print("_power_off_mean", all.model_mean, all.measured_mean);
  print("_power_off_median", all.model_median, all.measured_median);
}

void print_sky(const SkyTable& table, bool json) {
  const SkyFigures f = figures_of(table);
  const auto print = [&](const char* what, double value, double target) {
    print_figure({.name = "sky_" + table.name + what,
                  .value = value,
                  .unit = "mag",
                  .anchor = {},
                  .target = target,
                  .less_is_better = true},
                 json);
  };
  print("_median", f.median_mag, 0.0);
  print("_scatter", f.scatter_mag, 0.0);
  print("_worst", f.worst_mag, table.target_mag);
}

/// A predicted figure of a real frame, beside the measured one.
void print_beside(const ComparedFrame& frame, const char* what, double predicted,
                  const std::optional<double>& measured, const char* unit, bool json) {
  if (!measured) return;
  print_figure({.name = "frames_" + frame.name + what,
                .value = predicted,
                .unit = unit,
                .anchor = "measured",
                .anchor_value = *measured,
                .less_is_better = false},
               json);
}

void print_frames(const std::vector<ComparedFrame>& frames, bool json) {
  std::size_t as_wanted = 0;
  for (const ComparedFrame& f : frames) {
    as_wanted += f.as_wanted();
    if (!f.predicted) continue;
    print_beside(f, "_zero_point", f.predicted->zero_point_mag, f.measured.zero_point_mag, "mag",
                 json);
    print_beside(f, "_sky", f.predicted->sky_e, f.measured.sky_e, "e-", json);
    print_beside(f, "_noise", f.predicted->noise_e, f.measured.noise_e, "e-", json);
    print_beside(f, "_limit", f.predicted->limit_mag, f.measured.limit_mag, "mag", json);
  }
  print_figure({.name = "frames_found_as_wanted",
                .value = double(as_wanted),
                .unit = "frames",
                .anchor = {},
                .target = double(frames.size()),
                .less_is_better = false},
               json);
}

void print_detector(const DetectorFigures& f, bool json) {
  const auto print = [&](const char* what, double value, const char* unit, double target,
                         bool less_is_better = true) {
    print_figure({.name = "detector_" + f.sensor + what,
                  .value = value,
                  .unit = unit,
                  .anchor = {},
                  .target = target,
                  .less_is_better = less_is_better},
                 json);
  };
  print("_found", double(f.all.bin.found) / double(f.all.bin.truths), "of all", 0.0, false);
  print("_expected", f.all.expected / double(f.all.bin.truths), "of all", 0.0, false);
  print("_deviation", std::abs(f.deviation_sigma()), "sigma", 0.0);
  print("_false_positives", f.false_alarms_a_frame, "a frame", 0.0);
  print("_across_over_sigma", f.all.across_sigma.rms(), "", 1.2);
  print("_along_over_sigma", f.all.along_sigma.rms(), "", 1.2);
  print("_magnitude_bias", std::abs(f.all.magnitude.mean()), "mag", 0.0);
  print("_magnitude_over_sigma", f.all.magnitude_sigma.rms(), "", 1.2);
  print("_simsit_completeness", f.simsit.completeness, "", 0.0, false);
  print("_simsit_false_positive_rate", f.simsit.false_positive_rate, "", 0.0);
  print("_simsit_xy_rmse", f.simsit.xy_rmse_px, "px", 0.0);
  print("_simsit_flux_rmse", f.simsit.flux_rmse_mag, "mag", 0.0);
}

/// Prints the figures of real frames; returns their section of the page.
std::string compare_real_frames(const Options& options, const std::string& data) {
  Threads threads(1);
  const std::vector<ComparedFrame> frames = compare_frames(data, threads);
  print_frames(frames, options.json);
  return frames_section(frames);
}

/// Prints the figures of drawn frames.
std::vector<DetectorFigures> judge_detector(const Options& options) {
  Threads threads(1);
  const int frames = std::max(2, int(drawn_frames / options.every));
  auto sensors = detector_figures(draw_frames(frames, drawn_seed, threads));
  for (const DetectorFigures& f : sensors) print_detector(f, options.json);
  return sensors;
}

/// The page, and its charts in the folder of its name.
void write_page(const std::string& page, const std::vector<FamilyBrightness>& families,
                std::string more, const std::vector<DetectorFigures>& sensors) {
  const fs::path path = page;
  const std::string folder = path.stem().string();
  const fs::path beside = path.parent_path() / folder;
  make_directories(beside.string(), "--page");
  if (!sensors.empty()) {
    more += detector_section(sensors, folder);
    for (const char* kind : {point_sensor, streak_sensor})
      write_file_whole((beside / (std::string(kind) + ".svg")).string(),
                       chart_svg(completeness_chart(sensors, kind)));
  }
  for (const auto& family : families) {
    write_file_whole((beside / (family.model + ".svg")).string(),
                     chart_svg(difference_chart(family)));
    if (!family.held_out_power.bands.empty())
      write_file_whole(
          (beside / (family.model + "-power.svg")).string(),
          chart_svg(power_chart(family.held_out_power, family.what + ": light curves")));
  }
  write_file_whole(page, validation_page(families, folder) + more);
}

void validate(const Options& options) {
  const std::string data = data_of(options);
  if (needs_data(options) && !fs::is_directory(data))
    throw ConfigError(data + ": there are no measurements (--data DIR, or DMISE_DATA)");
  std::vector<FamilyBrightness> families;
  if (wanted(options, "brightness")) families = compare_brightness(data, options.every);
  for (const auto& family : families) {
    print_half(family.model + "_fitted", family.fitted, family, false, options.json);
    print_half(family.model + "_held_out", family.held_out, family, true, options.json);
    print_power(family.model + "_fitted", family.fitted_power, options.json);
    print_power(family.model + "_held_out", family.held_out_power, options.json);
    print_power_off(family.model + "_held_out", family.held_out_power, options.json);
  }
  if (!options.csv.empty()) write_file_whole(options.csv, brightness_csv(families));
  std::string more = wanted(options, "places") ? compare_places(options, data) : "";
  if (wanted(options, "sky")) {
    const std::vector<SkyTable> tables = compare_sky();
    for (const auto& table : tables) print_sky(table, options.json);
    more += sky_section(tables);
  }
  if (wanted(options, "frames")) more += compare_real_frames(options, data);
  std::vector<DetectorFigures> sensors;
  if (wanted(options, "detector")) sensors = judge_detector(options);
  if (const std::string page = page_of(options); !page.empty()) {
    write_page(page, families, more, sensors);
    if (!options.json) std::printf("%s\n", page.c_str());
  }
}

}  // namespace
}  // namespace dmise

// Started by `dmise validate`, with its arguments.
int main(int argc, char** argv) {
  CLI::App app{
      "Compares the models with measurements of the sky, and writes a page of what differs",
      "dmise validate"};
  app.set_version_flag("--version", dmise::version_text("dmise-validate"));
  dmise::Options options;
  app.add_option("names", options.names, "what to compare (all)")
      ->check(dmise::one_of({"brightness", "places", "sky", "frames", "detector"}));
  app.add_option(
      "--data", options.data,
      "directory of the measurements ($DMISE_DATA/validation, else shared/data/validation "
      "beside the checkout)");
  app.add_option("--page", options.page,
                 "page to write, its charts in a folder beside it (docs/validation.md; with names "
                 "or --json none)");
  app.add_option("--csv", options.csv, "file: each measurement, its prediction and its geometry");
  app.add_option("--every", options.every, "take every N-th measurement")
      ->capture_default_str()
      ->check(CLI::Range(1, 100));
  app.add_flag("--json", options.json, "print one JSON object per line");
  dmise::want_decimal_numbers(app);
  try {
    app.parse(argc, argv);
    dmise::validate(options);
    return 0;
  } catch (const CLI::ParseError& e) {
    return dmise::end_of_command_line(app, e);
  } catch (const dmise::ConfigError& e) {
    std::fprintf(stderr, "dmise validate: %s\n", e.what());
    return 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "dmise validate: %s\n", e.what());
    return 1;
  }
}
