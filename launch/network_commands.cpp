#include "core/base/error.h"
#include "launch/command/commands.h"
#include "launch/run/make_fusion.h"

namespace dmise {

static constexpr const char* no_fusion =
    "this part of the program has no fusion: ./dmise build makes the whole";

// The program that the demonstration builds first, as a part of the whole one.
void add_commands(CLI::App& app) {
  for (const auto add_command :
       {add_demo_command, add_check_command, add_explain_command, add_run_command,
        add_launch_command, add_join_command, add_report_command, add_list_command,
        add_schema_command, add_keygen_command, add_status_command, add_health_command,
        add_clock_command})
    add_command(app);
}

std::unique_ptr<Participant> make_fusion(const Scenario&, const Clock&, const std::string&,
                                         const OwnNodeSettings&, const std::shared_ptr<Tracker>&) {
  throw Error(no_fusion);
}

std::shared_ptr<Tracker> make_recorded_tracker(const Scenario&, const std::string&,
                                               const std::string&) {
  throw Error(no_fusion);
}

}  // namespace dmise
