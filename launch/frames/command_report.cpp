#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "launch/command/command.h"
#include "launch/run/write_report.h"

namespace dmise {
namespace {

struct ReportOptions {
  std::string run;
  int threads = 0;
};

void add_report_options(CLI::App& command) {
  auto options = std::make_shared<ReportOptions>();
  command.add_option("run", options->run, "directory of a run")->required();
  command
      .add_option("--threads", options->threads,
                  "number of threads; 0: one for each processor, at most 8")
      ->default_val(0)
      ->check(CLI::Range(0, 256));
  command.callback([options] {
    std::printf("%s\n", write_report(options->run, true, options->threads).c_str());
  });
}

}  // namespace

Command report_command() {
  return {.group = CommandGroup::frames,
          .summary = "Writes the page of a run, RUN/index.html, from its products alone",
          .details = "The run may have ended, been interrupted or still go on",
          .add_options = add_report_options};
}

}  // namespace dmise
