#pragma once
#include <string>

namespace CLI {
class App;
}

namespace dmise {

/// Adds the commands that the program has, in the order of its help: all of them
/// (all_commands.cpp), or those that run and watch networks (network_commands.cpp).
void add_commands(CLI::App& app);

// Subcommands of `dmise`. Each adds itself to the command line; its callback does the work and
// throws `ConfigError` (exit 2), `Error` (exit 1) or `ExitWith`.

/// Ends the program with a specific exit code, without a further message.
struct ExitWith {
  int code = 0;
};

void add_demo_command(CLI::App& app);
void add_check_command(CLI::App& app);
void add_explain_command(CLI::App& app);
void add_run_command(CLI::App& app);
void add_launch_command(CLI::App& app);
void add_join_command(CLI::App& app);
void add_dataset_command(CLI::App& app);
void add_detect_command(CLI::App& app);
void add_score_command(CLI::App& app);
void add_report_command(CLI::App& app);
void add_discriminate_command(CLI::App& app);
void add_export_command(CLI::App& app);
void add_solve_command(CLI::App& app);
void add_visible_command(CLI::App& app);
void add_view_command(CLI::App& app);
void add_calibrate_command(CLI::App& app);
void add_catalogue_command(CLI::App& app);
void add_conjunctions_command(CLI::App& app);
void add_list_command(CLI::App& app);
void add_keygen_command(CLI::App& app);
void add_status_command(CLI::App& app);
void add_health_command(CLI::App& app);
void add_clock_command(CLI::App& app);
void add_observatory_command(CLI::App& app);
void add_survey_command(CLI::App& app);
void add_tradeoff_command(CLI::App& app);
void add_bench_command(CLI::App& app);
void add_validate_command(CLI::App& app);
void add_schema_command(CLI::App& app);
void add_manual_commands(CLI::App& app);  // man, completion

}  // namespace dmise
