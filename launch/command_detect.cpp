#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "core/detection/detect_file.h"
#include "launch/commands.h"

namespace dmise {
namespace {

void print_detections(const std::string& path, int thread_count) {
  Threads threads(thread_count);
  for (const auto& line : detect_file(path, {}, threads).lines) std::printf("%s\n", line.c_str());
}

}  // namespace

void add_detect_command(CLI::App& app) {
  auto path = std::make_shared<std::string>();
  auto threads = std::make_shared<int>(1);
  auto* command =
      app.add_subcommand("detect",
                         "Detects moving objects in a frame, from its counts and header "
                         "alone; JSON lines as in detections.jsonl");
  command->add_option("frame", *path, "FITS file of a run")->required();
  command->add_option("--threads", *threads, "number of threads")
      ->default_val(1)
      ->check(CLI::Range(1, 256));
  command->callback([path, threads] { print_detections(*path, *threads); });
}

}  // namespace dmise
