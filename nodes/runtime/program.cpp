#include "nodes/runtime/program.h"

#include "core/base/error.h"
#include "nodes/runtime/log.h"

namespace dmise {

void add_common_flags(CLI::App& app, CommonFlags& flags) {
  app.add_option("--name", flags.name, "name of this node in the run")->capture_default_str();
  app.add_option("--master", flags.master, "address of the time-master, tcp://HOST:PORT")
      ->capture_default_str();
  app.add_option("--keys", flags.keys,
                 "directory of keys (dmise keygen); without it all is plain, on loopback alone");
  app.add_option("--log-level", flags.log_level, "trace, debug, info, warning, error or off")
      ->capture_default_str();
  app.add_option("--seed", flags.seed, "seed of every random draw")->capture_default_str();
  app.add_flag("--check", flags.check, "look at flags and files, then stop");
  app.set_version_flag("--version", std::string("dmise ") + DMISE_VERSION);
}

int run_program(CLI::App& app, const CommonFlags& flags, int argc, char** argv,
                const std::function<int()>& body) {
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  }
  try {
    start_log(flags.name.empty() ? app.get_name() : flags.name, flags.log_level);
    return body();
  } catch (const ConfigError& error) {
    spdlog::error("{}", error.what());
    return 2;
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return 1;
  }
}

}  // namespace dmise
