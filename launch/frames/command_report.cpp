#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "launch/command/commands.h"
#include "launch/run/write_report.h"

namespace dmise {
namespace {

struct ReportOptions {
  std::string run;
  int threads = 0;
};

}  // namespace

void add_report_command(CLI::App& app) {
  auto options = std::make_shared<ReportOptions>();
  auto* command =
      app.add_subcommand("report",
                         "Writes the page of a run, RUN/index.html, from its products "
                         "alone. The run may have ended, been interrupted or still go on");
  command->add_option("run", options->run, "directory of a run")->required();
  command
      ->add_option("--threads", options->threads,
                   "number of threads; 0: one for each processor, at most 8")
      ->default_val(0)
      ->check(CLI::Range(0, 256));
  command->callback([options] {
    std::printf("%s\n", write_report(options->run, true, options->threads).c_str());
  });
}

}  // namespace dmise
