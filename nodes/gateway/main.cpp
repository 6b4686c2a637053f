// dmise-gateway: shows a run to browsers.
#include <spdlog/spdlog.h>

#include <filesystem>

#include "core/base/error.h"
#include "core/base/files/whole_file.h"
#include "nodes/gateway/frame_previews.h"
#include "nodes/gateway/run_observer.h"
#include "nodes/gateway/web_server.h"
#include "nodes/runtime/process/event.h"
#include "nodes/runtime/process/host_port.h"
#include "nodes/runtime/process/json_log.h"
#include "nodes/runtime/program/command_line.h"
#include "nodes/runtime/program/program.h"
#include "nodes/runtime/security/security.h"

namespace dmise {
namespace {

struct GatewayOptions {
  std::string listen = "127.0.0.1:0", tokens, products, dashboard, announce_file;
  double answer_within_s = 0.0;
  bool no_control = false, truth = false;
};

/// The dashboard beside the programs: where it is built, or installed.
std::string default_dashboard() {
  std::error_code ignored;
  const auto bin = std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path();
  for (const char* place : {"../dashboard", "../share/dmise/dashboard"})
    if (std::filesystem::is_directory(bin / place, ignored))
      return (bin / place).lexically_normal().string();
  return {};
}

void set_address(const std::string& listen, WebServerOptions* options) {
  const auto address = host_and_port(listen);
  if (!address) throw ConfigError("--listen: must be HOST:PORT or [IPv6]:PORT, got " + listen);
  options->host = address->host;
  options->port = std::uint16_t(address->port);
}

int serve(const CommonFlags& flags, const GatewayOptions& options) {
  if (flags.master.empty()) throw ConfigError("--master: is required");
  WebServerOptions web;
  set_address(options.listen, &web);
  web.may_control = !options.no_control;
  web.shows_truth = options.truth;
  if (!options.tokens.empty()) web.tokens = read_access_tokens(options.tokens);
  if (!flags.keys.empty() && !web.tokens.any())
    throw ConfigError("--keys: a run with keys is not shown without --tokens");
  if (!flags.keys.empty()) Security(flags.keys, flags.name);
  const StaticFiles files(options.dashboard.empty() ? default_dashboard() : options.dashboard);
  if (flags.check) return 0;

  LatestMessages latest;
  ViewHistory history;
  FramePreviews previews(flags.keys, flags.name, options.products);
  RunObserver observer({.name = flags.name,
                        .master = flags.master,
                        .keys = flags.keys,
                        .takes_truth = options.truth,
                        .stop = &stop_signal(),
                        .answer_within_s = options.answer_within_s,
                        .frames_served_at =
                            [&](std::uint64_t run_id, std::map<std::string, std::string> sensors) {
                              previews.follow(run_id, std::move(sensors));
                            }},
                       latest, history);
  WebServer server(web, {files, latest, history, previews,
                         [&](const ClockCommand& command) { return observer.command(command); }});
  const std::string url = "http://" + text_of(HostPort{web.host, server.port()}) + "/";
  log_event(spdlog::level::info, "gateway_served", {{"url", url}}, "the live view is at " + url);
  if (files.empty()) spdlog::warn("the dashboard is not built: ./dmise dashboard");
  if (!options.announce_file.empty()) write_file_whole(options.announce_file, url + "\n");
  observer.run([&] { server.changed(); });
  return 0;
}

}  // namespace
}  // namespace dmise

int main(int argc, char** argv) {
  dmise::CommonFlags flags{.name = "gateway"};
  dmise::GatewayOptions options;
  CLI::App app("Shows a run to browsers: observes it and serves the dashboard.", "dmise-gateway");
  dmise::add_common_flags(app, flags);
  app.add_option("--listen", options.listen,
                 "IP address and port of the pages; port 0: any free port; addresses other than "
                 "loopback need --tokens")
      ->capture_default_str();
  app.add_option("--tokens", options.tokens,
                 "file with `view TOKEN`, `truth TOKEN` and `operator TOKEN`: who may watch, also "
                 "see truth, also control the clock");
  app.add_option("--products", options.products,
                 "directory of the run, for previews of frames that no sensor serves any more");
  app.add_option("--dashboard", options.dashboard, "directory of the built dashboard");
  app.add_option("--announce", options.announce_file, "file to write the URL to");
  app.add_flag(
      "--truth", options.truth,
      "show truth beside detections to viewers that may see it; with keys, the gateway's own "
      "must be allowed to receive truth");
  app.add_flag("--no-control", options.no_control, "viewers cannot control the clock");
  app.add_option("--answer-within", options.answer_within_s,
                 "end with an error if no time-master has answered in this time [s]; 0: wait")
      ->check(dmise::number_between(0.0, 1e6));
  return dmise::run_program(app, flags, argc, argv, [&] { return dmise::serve(flags, options); });
}
