#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <optional>

#include "core/detection/detect_file.h"
#include "launch/commands.h"
#include "launch/star_catalogue_option.h"

namespace dmise {
namespace {

struct DetectOptions {
  std::string frame, catalogue;
  int threads = 1;
};

void print_detections(const DetectOptions& o) {
  std::optional<CatalogueSky> sky;
  if (auto stars = load_star_catalogue(o.catalogue)) sky.emplace(std::move(stars));
  Threads threads(o.threads);
  for (const auto& line : detect_file(o.frame, {}, threads, sky ? &*sky : nullptr).lines)
    std::printf("%s\n", line.c_str());
}

}  // namespace

void add_detect_command(CLI::App& app) {
  auto o = std::make_shared<DetectOptions>();
  auto* command = app.add_subcommand(
      "detect",
      "Detects what is no star in a frame, from its counts and header and a catalogue of stars; "
      "JSON lines, the same as a run's detections.jsonl with the run's catalogue");
  command->add_option("frame", o->frame, "FITS file of a run")->required();
  add_star_catalogue_option(*command, o->catalogue, true);
  command->add_option("--threads", o->threads, "number of threads")
      ->default_val(1)
      ->check(CLI::Range(1, 256));
  command->callback([o] { print_detections(*o); });
}

}  // namespace dmise
