#include <CLI/CLI.hpp>
#include <memory>
#include <sstream>

#include "launch/command/command.h"

namespace dmise {
namespace {

const std::map<CommandGroup, std::string> group_titles{
    {CommandGroup::scenarios, "Scenarios"},
    {CommandGroup::networks, "Networks"},
    {CommandGroup::frames, "Frames and products of runs"},
    {CommandGroup::predictions, "Catalogues and predictions"},
    {CommandGroup::accuracy, "Accuracy and speed"},
    {CommandGroup::shell, "The shell"}};

/// The help of the program, which has a line for each command: its summary.
class ProgramHelp : public CLI::Formatter {
 public:
  explicit ProgramHelp(const std::map<std::string, Command>& commands) : commands_(commands) {
    constexpr std::size_t names_width = 16;
    column_width(names_width);
  }
  std::string make_subcommand(const CLI::App* command) const override {
    std::ostringstream line;
    const std::string& name = command->get_name();
    CLI::detail::format_help(line, name, commands_.at(name).summary, column_width_);
    return line.str();
  }

 private:
  std::map<std::string, Command> commands_;
};

}  // namespace

void add_commands(CLI::App& app, const std::map<std::string, Command>& commands) {
  for (const auto& [group, title] : group_titles)
    for (const auto& [name, command] : commands) {
      if (command.group != group) continue;
      const std::string more = command.details.empty() ? "" : ". " + command.details;
      command.add_options(*app.add_subcommand(name, command.summary + more)->group(title));
    }
  app.formatter(std::make_shared<ProgramHelp>(commands));
}

}  // namespace dmise
