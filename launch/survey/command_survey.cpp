#include <CLI/CLI.hpp>
#include <memory>

#include "launch/command/command.h"
#include "launch/command/common_options.h"
#include "launch/survey/survey_run.h"

namespace dmise {
namespace {

void add_survey_options(CLI::App& command) {
  auto o = std::make_shared<SurveyCommand>();
  command.add_option("scenario", o->scenario, "scenario (YAML)")->required();
  command
      .add_option("--out", o->out,
                  "directory of survey.json, the map and a directory for each sensor")
      ->capture_default_str();
  add_number_option(command, "--night", o->night_deg, -90.0, 90.0,
                    "sensors on the ground expose while the Sun is below this elevation [deg]");
  command
      .add_option("--shells", o->shells_km,
                  "limits of mean altitude between the shells of low orbits [km]")
      ->delimiter(',')
      ->capture_default_str()
      ->check(number_between(1.0, 2000.0));
  command.add_option("--optimise", o->optimise,
                     "sites=K: choose K of the places of sensors on the ground, for the most "
                     "objects detected a night");
  command
      .add_option("--check", o->check,
                  "render this many frames and compare their detections with the survey's")
      ->check(CLI::Range(std::size_t(1), std::size_t(100000)));
  command
      .add_option("--fit", o->fit,
                  "render this many other frames first and take the probability of detection "
                  "from them")
      ->check(CLI::Range(std::size_t(1), std::size_t(100000)));
  command.add_flag("--json", o->json, "print survey.json instead of tables");
  add_threads_option(command, o->threads, "number of threads; the products do not depend on it");
  command.footer("docs/models/survey.md describes the method and its accuracy");
  command.callback([o] { run_survey(*o); });
}

}  // namespace

Command survey_command() {
  return {
      .group = CommandGroup::predictions,
      .summary = "Tells what a network detects in whole nights, without rendering; chooses sites",
      .details =
          "Coverage, detection and revisit of each shell of orbits. Goes on where it was stopped",
      .add_options = add_survey_options};
}

}  // namespace dmise
