#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "core/base/error.h"
#include "core/base/files/paths.h"
#include "core/base/files/regular_file.h"
#include "core/base/files/whole_file.h"
#include "core/base/printable.h"
#include "core/score/foreign_frames.h"
#include "core/score/score_charts.h"
#include "core/score/score_text.h"
#include "core/score/scored_run.h"
#include "launch/command/command.h"
#include "launch/command/common_options.h"
#include "launch/run/progress.h"
#include "launch/run/star_catalogue_option.h"

namespace dmise {
namespace {

struct ScoreOptions {
  std::string run, frames, truth, csv, plots, catalogue;
  bool json = false;
  int threads = 1;
  ScoreSettings settings;
};

ScoreInput input_of(const ScoreOptions& options) {
  if (options.run.empty() == options.frames.empty())
    throw ConfigError("score: give the directory of a run, or --frames and --truth");
  Progress progress;
  const auto show = [&](double share, const std::string& file) {
    progress.show_share(share, "score: " + printable(file));
  };
  Threads threads(options.threads);
  auto input = options.run.empty()
                   ? read_frames(options.frames, options.truth, threads, show,
                                 CalibratedDetector(load_star_catalogue(options.catalogue)))
                   : read_run(options.run, show);
  progress.clear_line();
  return input;
}

void run_score(const ScoreOptions& options) {
  const std::string csv = options.csv.empty() ? "" : file_to_write("--csv", options.csv);
  const Score result = score(input_of(options), options.settings);
  if (!csv.empty()) write_file_whole(csv, score_csv(result));
  if (!options.plots.empty()) {
    make_directories(options.plots, "--plots");
    write_file_whole(options.plots + "/detection.svg", chart_svg(detection_chart(result)));
    write_file_whole(options.plots + "/position.svg", chart_svg(position_chart(result)));
    write_file_whole(options.plots + "/magnitude.svg", chart_svg(magnitude_chart(result)));
  }
  const std::string text = options.json ? score_json(result) : score_table(result);
  std::fwrite(text.data(), 1, text.size(), stdout);
}

void add_score_options(CLI::App& command) {
  auto options = std::make_shared<ScoreOptions>();
  auto* run = command.add_option("run", options->run, "directory of a run that has ended");
  auto* frames =
      command.add_option("--frames", options->frames, "directory of FITS frames, instead of a run");
  auto* truth = command.add_option("--truth", options->truth, truth_csv_help);
  frames->needs(truth)->excludes(run);
  truth->needs(frames);
  add_star_catalogue_option(command, options->catalogue, true);
  add_threads_option(command, options->threads, "number of threads that detect in --frames");
  add_number_option(command, "--gate-px", options->settings.gate_px, 0.1, 1000.0,
                    "greatest distance of a detection from its truth's trail");
  add_number_option(
      command, "--threshold", options->settings.threshold_snr, 0.0, 1000.0,
      "SNR at which the detector finds half; sources of a lower expected SNR that are "
      "not found count as faint, not as missed");
  command.add_flag("--json", options->json, "print JSON");
  command.add_option("--csv", options->csv, "file: a row per truth and per false alarm");
  command.add_option("--plots", options->plots,
                     "directory: detection.svg, position.svg, magnitude.svg");
  command.callback([options] { run_score(*options); });
}

}  // namespace

Command score_command() {
  return {.group = CommandGroup::frames,
          .summary = "Compares detections with truth, of a run or of any FITS frames",
          .details =
              "Probability of detection, false alarms, errors of position, magnitude and ends, and "
              "whether their covariances are honest. In FITS frames it detects itself",
          .add_options = add_score_options};
}

}  // namespace dmise
