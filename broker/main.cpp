// dmise-broker: forwards messages from publishers to subscribers, from the start of a run to its
// end.
#include "core/base/error.h"
#include "nodes/runtime/broker/broker.h"
#include "nodes/runtime/program/command_line.h"
#include "nodes/runtime/program/program.h"

int main(int argc, char** argv) {
  dmise::CommonFlags flags{.name = "broker"};
  dmise::BrokerOptions options;
  CLI::App app("Forwards messages from publishers to subscribers until the run is over.",
               "dmise-broker");
  dmise::add_common_flags(app, flags);
  app.add_option("--publish", options.publish, "publishers connect here")
      ->capture_default_str()
      ->check(dmise::transport_address());
  app.add_option("--subscribe", options.subscribe, "nodes of the run subscribe here")
      ->capture_default_str()
      ->check(dmise::transport_address());
  app.add_option("--observe", options.observe, "observers subscribe here")
      ->capture_default_str()
      ->check(dmise::transport_address());
  app.add_option("--observer-queue", options.observer_queue, "messages queued for a slow observer")
      ->check(CLI::PositiveNumber)
      ->capture_default_str();
  return dmise::run_program(app, flags, argc, argv, [&] {
    if (flags.master.empty()) throw dmise::ConfigError("--master: is required");
    options.master = flags.master;
    options.keys = flags.keys;
    options.stop = &dmise::stop_signal();
    return flags.check ? 0 : dmise::run_broker(options).exit_code;
  });
}
