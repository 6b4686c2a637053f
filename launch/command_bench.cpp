#include <CLI/CLI.hpp>
#include <memory>

#include "bench/benches.h"
#include "launch/commands.h"

namespace dmise {

void add_bench_command(CLI::App& app) {
  auto* command = app.add_subcommand("bench", "Measures; with --json one object a line");
  command->require_subcommand(1);
  for (const auto& bench : benches()) {
    auto json = std::make_shared<bool>(false);
    auto* one = command->add_subcommand(bench.name, bench.what);
    one->add_flag("--json", *json, "one JSON object a line");
    if (bench.add_options) bench.add_options(*one);
    one->callback([json, run = bench.run] {
      if (const int code = run(*json)) throw ExitWith{code};
    });
  }
}

}  // namespace dmise
