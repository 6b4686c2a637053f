#include "bench/bench_survey.h"

#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <memory>
#include <sstream>
#include <string>
#include <vector>

#include "bench/catalogue_file.h"
#include "bench/figure.h"
#include "bench/timing.h"
#include "core/base/error.h"
#include "core/config/make_clock.h"
#include "core/config/yaml/search_path.h"
#include "orbit-node/load_objects.h"
#include "sensors/accuracy/rendered_check.h"
#include "sensors/frame/make_sensor.h"
#include "sensors/survey/survey_summary.h"

namespace dmise {
namespace {

struct SurveyBench {
  int threads = 2;
  std::size_t frames = 208;
  bool no_night = false, no_choice = false, no_frames = false;
  std::string csv;
};
SurveyBench asked;

/// The places of the network of launch/scenarios/survey.yaml.
constexpr std::array network = {"haleakala",    "la-palma", "siding-spring", "sutherland",
                                "cerro-tololo", "mcdonald", "xinglong",      "wise"};

struct Place {
  double latitude_deg, longitude_deg, height_m;
};
/// Maunakea, Kitt Peak, Parkes, Calar Alto, Okayama, Hanle, MeerKAT and Paranal: no place of the
/// frames in which detection was measured.
constexpr std::array<Place, 8> elsewhere = {{{19.826667, -155.471667, 4215},
                                             {31.963333, -111.6, 2120},
                                             {-32.998406, 148.26351, 415},
                                             {37.223611, -2.546111, 2168},
                                             {34.577075, 133.593956, 370},
                                             {32.779444, 78.964167, 4500},
                                             {-30.711056, 21.443889, 1087},
                                             {-24.627439, -70.404989, 2669}}};

/// A piece of the all-sky camera `omnissa`, of which many frames can be rendered.
constexpr const char* piece_of_omnissa =
    "{name: piece, optics: {projection: gnomonic, columns: 1100, rows: 1100, pixel_pitch_m: "
    "5.4e-6, focal_length_m: 8.9802e-3, aperture_m: 0.0375, transmission: 0.8, psf_fwhm_px: 1.5, "
    "equivalent_aperture: true}, detector: {quantum_efficiency: 0.54, dark_e_per_s: 0.02, "
    "read_noise_e: 9.3, full_well_e: 25500, gain_e_per_dn: 0.35, bias_dn: 100, adc_bits: 16}, "
    "band: {name: V, centre_m: 0.55e-6, width_m: 0.128e-6}}";

std::string head_of(const WrittenCatalogue& catalogue, const std::string& start_utc) {
  return "simulation: {start: " + start_utc +
         ", duration_s: 86400, tick_s: 10, seed: 1}\nobjects: [{catalogue: " + catalogue.path +
         "}]\nstars: {catalogue: kstars}\nsensors:\n";
}

/// The sensors of launch/scenarios/survey-sites.yaml.
std::string all_candidates() {
  std::ifstream file(home_directory() + "/launch/scenarios/survey-sites.yaml");
  std::string line, text;
  while (std::getline(file, line))
    if (line.starts_with("  - {name: ")) text += line + "\n";
  if (text.empty()) throw Error("bench survey: launch/scenarios/survey-sites.yaml has no sensors");
  return text;
}

/// A scenario with what its surveys share.
struct Surveyed {
  Surveyed(const std::filesystem::path& file, const std::string& yaml) : threads(asked.threads) {
    std::ofstream(file) << yaml;
    scenario = load_scenario(file.string());
    population = load_objects(scenario, make_clock(scenario));
    shells =
        shells_of(population, {std::begin(usual_shell_limits_km), std::end(usual_shell_limits_km)});
    scene = std::make_unique<SurveyScene>(scenario, population, make_clock(scenario),
                                          load_stars(scenario), threads);
  }
  std::vector<SensorSurvey> surveys() {
    std::vector<SensorSurvey> all;
    for (const SensorConfig& sensor : scenario.sensors) {
      all.push_back(survey_sensor(*scene, sensor, shells, threads));
      std::fprintf(stderr, "\r%zu of %zu sensors", all.size(), scenario.sensors.size());
    }
    std::fputs("\n", stderr);
    return all;
  }

  Threads threads;
  Scenario scenario;
  ObjectPopulation population;
  Shells shells;
  std::unique_ptr<SurveyScene> scene;
};

/// Surveys of whole nights; wall time from the scenario's file to the summary.
void measure_night(const std::filesystem::path& directory, const WrittenCatalogue& catalogue,
                   bool json) {
  std::string yaml = head_of(catalogue, catalogue.start_utc);
  for (const char* site : network)
    yaml += std::string("  - {name: ") + site + ", site: " + site +
            ", camera: omnissa, pointing: zenith, exposure_s: 20, cadence_s: 30, sky: dark}\n";
  const double start = seconds_of(CLOCK_MONOTONIC), cpu_start = process_seconds();
  Surveyed night(directory / "night.yaml", yaml);
  const auto surveys = night.surveys();
  const auto summary =
      summarise_survey(surveys, night.shells, std::vector<double>(surveys.size(), 30.0), 1);
  print_figure({"survey_night_s", seconds_of(CLOCK_MONOTONIC) - start, "s", "", 0, 60, true}, json);
  print_figure({"survey_night_cpu_s", process_seconds() - cpu_start, "s"}, json);
  print_figure({"survey_night_objects", double(summary.run.all.objects), "1"}, json);
  print_figure({"survey_night_covered", double(summary.run.all.covered), "1"}, json);
  print_figure({"survey_night_detected", summary.run.all.detected, "1"}, json);
}

void measure_choice(const std::filesystem::path& directory, const WrittenCatalogue& catalogue,
                    bool json) {
  const double start = seconds_of(CLOCK_MONOTONIC), cpu_start = process_seconds();
  Surveyed sites(directory / "sites.yaml",
                 head_of(catalogue, catalogue.start_utc) + all_candidates());
  const auto surveys = sites.surveys();
  const auto candidates = candidate_sites(sites.scenario.sensors);
  const SiteChoice choice = choose_sites(
      misses_of(surveys, candidates, sites.population.roster.objects.size(), 1), network.size());
  print_figure({"survey_choice_s", seconds_of(CLOCK_MONOTONIC) - start, "s", "", 0, 300, true},
               json);
  print_figure({"survey_choice_cpu_s", process_seconds() - cpu_start, "s"}, json);
  print_figure({"survey_choice_detected", choice.best, "1", "no choice has more", choice.bound},
               json);
  std::string names;
  for (const std::size_t s : choice.sites) names += " " + candidates[s].name;
  std::fprintf(stderr, "chosen:%s\n", names.c_str());
}

/// Compares with rendered frames of another night, other places and other pointings than those in
/// which detection was measured.
bool measure_frames(const std::filesystem::path& directory, const WrittenCatalogue& catalogue,
                    bool json) {
  std::ostringstream yaml;
  const std::string other_day =
      catalogue.start_utc.substr(0, 8) + "23" + catalogue.start_utc.substr(10);
  yaml << head_of(catalogue, other_day);
  for (std::size_t k = 0; k < elsewhere.size(); ++k)
    yaml << "  - {name: piece-" << k << ", site: {latitude_deg: " << elsewhere[k].latitude_deg
         << ", longitude_deg: " << elsewhere[k].longitude_deg
         << ", height_m: " << elsewhere[k].height_m << "}, camera: " << piece_of_omnissa
         << ", pointing: {azimuth_deg: " << 33 + 45 * k << ", elevation_deg: " << 43 + 5 * k
         << "}, exposure_s: 20, cadence_s: 30, sky: dark}\n";
  Surveyed pieces(directory / "pieces.yaml", yaml.str());
  SurveyOptions options;
  options.progress = [](double share) {
    std::fprintf(stderr, "\rrendering frames: %.0f %%", 100 * share);
  };
  const RenderedCheck check =
      check_rendered(*pieces.scene, asked.frames, FrameHalf::even, pieces.threads, options);
  std::fputs("\n", stderr);
  if (!asked.csv.empty()) std::ofstream(asked.csv) << check_csv(check);
  print_figure({"survey_frames", double(check.frames), "1", "", 0, 200}, json);
  print_figure({"survey_expected", check.expected(), "1"}, json);
  print_figure({"survey_found", double(check.found()), "1"}, json);
  const double deviation = std::abs(check.deviation_sigma());
  print_figure({"survey_deviation_sigma", deviation, "1", "", 0, 2, true}, json);
  return deviation <= 2.0;
}

}  // namespace

void add_survey_options(CLI::App& app) {
  app.add_option("--threads", asked.threads, "number of threads")->capture_default_str();
  app.add_option("--frames", asked.frames, "frames that are rendered")->capture_default_str();
  app.add_flag("--no-night", asked.no_night, "leave out the time of a night");
  app.add_flag("--no-choice", asked.no_choice, "leave out the choice of 8 of 64 sites");
  app.add_flag("--no-frames", asked.no_frames, "leave out the rendered frames");
  app.add_option("--csv", asked.csv, "file of the objects in the rendered frames");
}

namespace {

std::filesystem::path made_directory() {
  const auto directory =
      std::filesystem::temp_directory_path() / ("dmise-bench-survey-" + std::to_string(getpid()));
  std::filesystem::create_directories(directory);
  return directory;
}

}  // namespace

void bench_survey_night(bool json) {
  const auto directory = made_directory();
  measure_night(directory, catalogue_of_18470(directory), json);
  std::filesystem::remove_all(directory);
}

int bench_survey(bool json) {
  const auto directory = made_directory();
  const WrittenCatalogue catalogue = catalogue_of_18470(directory);
  bool good = true;
  if (!asked.no_night) measure_night(directory, catalogue, json);
  if (!asked.no_choice) measure_choice(directory, catalogue, json);
  if (!asked.no_frames) good = measure_frames(directory, catalogue, json);
  std::filesystem::remove_all(directory);
  return good ? 0 : 1;
}

}  // namespace dmise
