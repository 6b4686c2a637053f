#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "bench/benches.h"
#include "core/base/memory.h"
#include "nodes/runtime/program/command_line.h"
#include "nodes/runtime/program/version_text.h"

// Started by `dmise bench`, with its arguments.
int main(int argc, char** argv) {
  dmise::return_large_blocks();
  CLI::App app{"Runs benchmarks; with --json one object per line", "dmise bench"};
  app.set_version_flag("--version", dmise::version_text("dmise-bench"));
  app.require_subcommand(1);
  app.footer("Studies, which ./dmise bench builds when they are asked for: paper, scaling");
  int code = 0;
  for (const auto& bench : dmise::benches()) {
    auto json = std::make_shared<bool>(false);
    auto* one = app.add_subcommand(bench.name, bench.what);
    one->add_flag("--json", *json, "print one JSON object per line");
    if (bench.add_options) bench.add_options(*one);
    one->callback([&code, json, run = bench.run] { code = run(*json); });
  }
  try {
    app.parse(argc, argv);
    return code;
  } catch (const CLI::ParseError& e) {
    return dmise::end_of_command_line(app, e);
  } catch (const std::exception& e) {
    std::fprintf(stderr, "dmise bench: %s\n", e.what());
    return 1;
  }
}
