#pragma once
#include <map>
#include <string>

namespace CLI {
class App;
}

namespace dmise {

/// The parts of the help of `dmise`, in its order.
enum class CommandGroup { scenarios, networks, frames, predictions, accuracy, shell };

/// A command of `dmise`. `launch/*/command_NAME.cpp` defines `Command NAME_command()`; the build
/// lists the commands by the names of these files, and `./dmise` reads their summaries there.
struct Command {
  CommandGroup group;
  std::string summary;  // a sentence without its full stop, in the help of `dmise`
  std::string details;  // what the command's own help says after that; may be empty
  /// Adds options and the callback that does the work and throws `ConfigError` (exit 2), `Error`
  /// (exit 1) or `ExitWith`.
  void (*add_options)(CLI::App& command);
};

/// Returns the commands of this program by their names. The build writes it, for each program.
std::map<std::string, Command> commands();

/// Adds commands to the command line: by groups, and by names within them.
void add_commands(CLI::App& app, const std::map<std::string, Command>& commands);

/// Ends the program with a specific exit code, without a further message.
struct ExitWith {
  int code = 0;
};

}  // namespace dmise
