#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <map>
#include <memory>

#include "core/base/error.h"
#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "core/sim/run_phase.h"
#include "launch/command/commands.h"
#include "launch/command/common_options.h"
#include "launch/process/status_watch.h"
#include "nodes/runtime/observability/status.h"
#include "nodes/runtime/process/event.h"

namespace dmise {
namespace {

struct StatusOptions {
  std::string master, keys;
  bool once = false, watch = false, healthy = false;
  ClockRequest request;  // what `dmise clock` asks for
};

constexpr double patience_s = 2.0;
constexpr auto interval = std::chrono::milliseconds(500);

Security security_of(const StatusOptions& options) { return {options.keys, operator_name}; }

std::string table(const RunStatus& status) {
  std::string text =
      formatted("run %016llx  %s%s  tick %ld of %ld  %.1f s simulated\n",
                static_cast<unsigned long long>(status.run_id), phase_name(status.phase),
                status.paused ? ", paused" : "", long(status.settled), long(status.last_tick),
                double(std::max<Tick>(status.settled, 0)) * status.tick_length.seconds());
  if (!status.start_utc.empty()) text += "start: " + printable(status.start_utc) + "\n";
  if (!status.cause.empty()) text += "cause: " + printable(status.cause) + "\n";
  if (!status.missing.empty()) text += "missing: " + printable(joined(status.missing)) + "\n";
  if (!status.holding.empty()) text += "waiting for: " + printable(joined(status.holding)) + "\n";
  if (status.pace > 0.0) text += formatted("pace: %g times real time\n", status.pace);
  if (status.overruns > 0)
    text += formatted("overruns: %llu, at most %.2f s late\n",
                      static_cast<unsigned long long>(status.overruns), status.worst_lag_s);
  text += formatted("%-24s %-8s %6s %5s %10s %10s %10s\n", "node", "state", "tick", "start",
                    "compute s", "message s", "wait s");
  for (const auto& node : status.nodes)
    text +=
        formatted("%-24s %-8s %6ld %5llu %10.2f %10.2f %10.2f\n", printable(node.name, 64).c_str(),
                  !node.alive     ? "lost"
                  : node.observer ? "observes"
                                  : "alive",
                  long(node.done), static_cast<unsigned long long>(node.incarnation),
                  node.times.compute_s, node.times.messaging_s, node.times.waiting_s);
  return text;
}

/// The clock runs, or waits for the start or its end, and no node is lost.
bool healthy(const RunStatus& status) {
  for (const auto& node : status.nodes)
    if (!node.alive && status.phase == Phase::running) return false;
  return status.phase != Phase::failed;
}

double seconds_now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

/// The terminal while it shows a live table: alternate screen, no echo, keys without Enter. The
/// destructor restores it.
class LiveTerminal {
 public:
  LiveTerminal() {
    keys_ = isatty(STDIN_FILENO) && tcgetattr(STDIN_FILENO, &before_) == 0;
    if (keys_) {
      termios live = before_;
      live.c_lflag &= tcflag_t(~(ICANON | ECHO));
      tcsetattr(STDIN_FILENO, TCSANOW, &live);
    }
    std::fputs("\x1b[?1049h\x1b[?25l", stdout);
  }
  ~LiveTerminal() {
    std::fputs("\x1b[?25h\x1b[?1049l", stdout);
    std::fflush(stdout);
    if (keys_) tcsetattr(STDIN_FILENO, TCSANOW, &before_);
  }
  LiveTerminal(const LiveTerminal&) = delete;
  LiveTerminal& operator=(const LiveTerminal&) = delete;

  StatusWatch::Layout layout() const {
    winsize size{};
    StatusWatch::Layout layout{.colours = wants_colours(true, getenv("NO_COLOR"), getenv("TERM"))};
    if (ioctl(STDOUT_FILENO, TIOCGWINSZ, &size) == 0 && size.ws_col > 0 && size.ws_row > 0)
      layout.columns = size.ws_col, layout.rows = size.ws_row;
    return layout;
  }
  /// Each line overwrites the old one, so that nothing flickers.
  void show(const std::string& text) const {
    std::string screen = "\x1b[H";
    for (const char c : text) screen += c == '\n' ? std::string("\x1b[K\n") : std::string(1, c);
    std::fputs((screen + "q ends\x1b[J").c_str(), stdout);
    std::fflush(stdout);
  }
  /// Waits; true if q was pressed or the stop signal came.
  bool ended(std::chrono::milliseconds within) const {
    const Event& stop = stop_signal();
    pollfd wait[] = {{.fd = stop.fd(), .events = POLLIN, .revents = 0},
                     {.fd = STDIN_FILENO, .events = POLLIN, .revents = 0}};
    poll(wait, keys_ ? 2 : 1, int(within.count()));
    char key = 0;
    return stop.is_set() ||
           (wait[1].revents != 0 && (read(STDIN_FILENO, &key, 1) <= 0 || key == 'q' || key == 'Q'));
  }

 private:
  termios before_{};
  bool keys_ = false;
};

/// Shows the run until it ends, q or Ctrl-C is pressed, or no answer comes for `lost_after_s`.
void watch(const StatusOptions& options, const Security& security, const RunStatus& status) {
  constexpr double lost_after_s = 10.0;
  stop_signal();
  StatusWatch run;
  run.take(status, seconds_now());
  {
    const LiveTerminal terminal;
    while (true) {
      terminal.show(run.table(terminal.layout()));
      if (run.status().phase == Phase::ended || run.status().phase == Phase::failed) break;
      if (terminal.ended(interval)) return;
      try {
        run.take(ask_master(options.master, patience_s, security), seconds_now());
      } catch (const Error& error) {
        run.miss(error.what(), seconds_now());
        if (run.silent_s() > lost_after_s) break;
      }
    }
  }
  std::fputs(run.table({.columns = 500, .rows = 100'000}).c_str(), stdout);
  if (run.silent_s() > lost_after_s) throw Error(options.master + ": does not answer any more");
}

void show(const StatusOptions& options) {
  const Security security = security_of(options);
  RunStatus status = ask_master(options.master, patience_s, security);
  if (options.healthy) {
    if (!healthy(status)) throw Error(status.cause.empty() ? "a node is lost" : status.cause);
    return;
  }
  if (options.once || !isatty(STDOUT_FILENO)) {
    std::fputs(table(status).c_str(), stdout);
    return;
  }
  watch(options, security, status);
}

void control(const StatusOptions& options) {
  const RunStatus status =
      control_master(options.master, patience_s, options.request, security_of(options));
  std::fputs(table(status).c_str(), stdout);
}

void add_pace_verb(CLI::App& clock) {
  auto options = std::make_shared<StatusOptions>();
  options->request.action = ClockAction::pace;
  auto* verb = clock.add_subcommand("pace", "sets how fast simulated time passes");
  add_master_option(*verb, "master", options->master)->required();
  verb->add_option("factor", options->request.factor,
                   "simulated seconds per second, 0 to 1e6; 0: as fast as possible")
      ->required()
      ->check(number_between(0.0, 1e6));
  verb->add_option("--keys", options->keys, "directory with operator.key");
  verb->callback([options] { control(*options); });
}

}  // namespace

void add_status_command(CLI::App& app) {
  auto options = std::make_shared<StatusOptions>();
  auto* command =
      app.add_subcommand("status", "Shows the clock and nodes of a run; live on a terminal");
  add_master_option(*command, "master", options->master)->required();
  command->add_option("--keys", options->keys, "directory with operator.key");
  auto* once = command->add_flag("--once", options->once, "print once, also on a terminal");
  command
      ->add_flag("--watch", options->watch,
                 "a live table until the run ends, q or Ctrl-C, as on a terminal without --once; "
                 "elsewhere it is printed once")
      ->excludes(once);
  command->add_flag("--healthy", options->healthy,
                    "print nothing; exit with 0 if the run has not failed and no node is lost");
  command->callback([options] { show(*options); });
}

void add_clock_command(CLI::App& app) {
  auto* command = app.add_subcommand("clock", "Pauses, steps, paces or ends a run");
  command->require_subcommand(1);
  const std::map<std::string, std::pair<ClockAction, std::string>> actions{
      {"pause", {ClockAction::pause, "stop after the last granted tick, or after this one"}},
      {"step", {ClockAction::step, "run this many more ticks (default 1), then pause again"}},
      {"go-on", {ClockAction::go_on, "end a pause"}},
      {"end", {ClockAction::end_early, "end the run when all granted ticks are done"}},
      {"abort", {ClockAction::abort, "end the run at once"}}};
  for (const auto& [name, action] : actions) {
    auto options = std::make_shared<StatusOptions>();
    const bool steps = action.first == ClockAction::step;
    options->request = {.action = action.first, .tick = steps ? 1 : 0};
    auto* verb = command->add_subcommand(name, action.second);
    add_master_option(*verb, "master", options->master)->required();
    verb->add_option("--keys", options->keys, "directory with operator.key");
    if (steps || action.first == ClockAction::pause)
      verb->add_option(steps ? "ticks,--tick" : "tick,--tick", options->request.tick,
                       steps ? "number of ticks" : "tick")
          ->check(CLI::Range(Tick(steps), Tick(1) << 40));
    if (action.first == ClockAction::end_early || action.first == ClockAction::abort)
      verb->add_option("--reason", options->request.reason, "cause to record");
    verb->callback([options] { control(*options); });
  }
  add_pace_verb(*command);
}

}  // namespace dmise
