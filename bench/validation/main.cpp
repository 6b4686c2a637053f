#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstdlib>
#include <filesystem>

#include "bench/figure.h"
#include "bench/validation/brightness.h"
#include "bench/validation/validation_page.h"
#include "core/base/error.h"
#include "core/base/paths.h"
#include "core/base/text_file.h"
#include "core/base/whole_file.h"
#include "core/config/search_path.h"
#include "nodes/runtime/program/command_line.h"
#include "nodes/runtime/program/version_text.h"

namespace dmise {
namespace {

namespace fs = std::filesystem;

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

void write_page(const std::string& page, const std::vector<FamilyBrightness>& families,
                const std::string& places) {
  const fs::path path = page;
  const std::string folder = path.stem().string();
  const fs::path beside = path.parent_path() / folder;
  make_directories(beside.string(), "--page");
  for (const auto& family : families)
    write_file_whole((beside / (family.model + ".svg")).string(),
                     chart_svg(difference_chart(family)));
  write_file_whole(page, validation_page(families, folder) + places);
}

void validate(const Options& options) {
  const std::string data = data_of(options);
  if (!fs::is_directory(data))
    throw ConfigError(data + ": there are no measurements (--data DIR, or DMISE_DATA)");
  std::vector<FamilyBrightness> families;
  if (wanted(options, "brightness")) families = compare_brightness(data, options.every);
  for (const auto& family : families) {
    print_half(family.model + "_fitted", family.fitted, family, false, options.json);
    print_half(family.model + "_held_out", family.held_out, family, true, options.json);
  }
  if (!options.csv.empty()) write_file_whole(options.csv, brightness_csv(families));
  const std::string places = wanted(options, "places") ? compare_places(options, data) : "";
  if (const std::string page = page_of(options); !page.empty()) {
    write_page(page, families, places);
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
      ->check(dmise::one_of({"brightness", "places"}));
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
