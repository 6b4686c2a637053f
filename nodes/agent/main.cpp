// dmise-host-agent: connects the nodes of one host to the run.
#include "core/base/error.h"
#include "nodes/agent/host_agent.h"
#include "nodes/runtime/program/command_line.h"
#include "nodes/runtime/program/program.h"

int main(int argc, char** argv) {
  dmise::CommonFlags flags{.name = "host-1"};
  dmise::HostAgentOptions options;
  CLI::App app("Connects the nodes of one host to the run, as one of its members.",
               "dmise-host-agent");
  dmise::add_common_flags(app, flags);
  app.add_option("--bind", options.bind,
                 "the address that the nodes of this host join: "
                 "tcp://HOST:PORT or ipc://PATH")
      ->capture_default_str()
      ->check(dmise::transport_address());
  app.add_option("--announce", options.announce_file, "file to write the address to");
  app.add_option("--announce-fd", options.announce_fd, "file descriptor to write the address to");
  return dmise::run_program(app, flags, argc, argv, [&] {
    if (flags.master.empty()) throw dmise::ConfigError("--master: is required");
    options.name = flags.name;
    options.master = flags.master;
    options.keys = flags.keys;
    options.stop = &dmise::stop_signal();
    return flags.check ? 0 : dmise::run_host_agent(options).exit_code;
  });
}
