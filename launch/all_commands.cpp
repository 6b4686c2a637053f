#include "launch/command/commands.h"

namespace dmise {

void add_commands(CLI::App& app) {
  for (const auto add_command :
       {add_demo_command,        add_check_command,        add_explain_command,
        add_run_command,         add_launch_command,       add_join_command,
        add_dataset_command,     add_detect_command,       add_score_command,
        add_report_command,      add_discriminate_command, add_export_command,
        add_solve_command,       add_calibrate_command,    add_visible_command,
        add_view_command,        add_catalogue_command,    add_conjunctions_command,
        add_list_command,        add_schema_command,       add_keygen_command,
        add_status_command,      add_health_command,       add_clock_command,
        add_observatory_command, add_survey_command,       add_tradeoff_command,
        add_bench_command,       add_validate_command,     add_manual_commands})
    add_command(app);
}

}  // namespace dmise
