#include <CLI/CLI.hpp>
#include <cstdio>

#include "core/base/error.h"
#include "core/base/memory.h"
#include "core/base/printable.h"
#include "launch/commands.h"
#include "nodes/runtime/program/command_line.h"
#include "nodes/runtime/program/version_text.h"

int main(int argc, char** argv) {
  dmise::return_large_blocks();
  CLI::App app{"Simulates a network of optical sensors that watch near-Earth space.", "dmise"};
  app.set_version_flag("--version", dmise::version_text("dmise"));
  app.require_subcommand(1);
  dmise::add_demo_command(app);
  dmise::add_check_command(app);
  dmise::add_explain_command(app);
  dmise::add_run_command(app);
  dmise::add_launch_command(app);
  dmise::add_join_command(app);
  dmise::add_dataset_command(app);
  dmise::add_detect_command(app);
  dmise::add_score_command(app);
  dmise::add_report_command(app);
  dmise::add_discriminate_command(app);
  dmise::add_export_command(app);
  dmise::add_solve_command(app);
  dmise::add_visible_command(app);
  dmise::add_view_command(app);
  dmise::add_catalogue_command(app);
  dmise::add_list_command(app);
  dmise::add_schema_command(app);
  dmise::add_keygen_command(app);
  dmise::add_status_command(app);
  dmise::add_health_command(app);
  dmise::add_clock_command(app);
  dmise::add_survey_command(app);
  dmise::add_tradeoff_command(app);
  dmise::add_bench_command(app);
  dmise::add_manual_commands(app);
  constexpr std::size_t longest = 4000;  // of an error message [bytes]
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& e) {
    return dmise::end_of_command_line(app, e);
  } catch (const dmise::ExitWith& e) {
    return e.code;
  } catch (const dmise::ConfigError& e) {
    std::fprintf(stderr, "dmise: %s\n", dmise::printable(e.what(), longest).c_str());
    return 2;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "dmise: %s\n", dmise::printable(e.what(), longest).c_str());
    return 1;
  }
}
