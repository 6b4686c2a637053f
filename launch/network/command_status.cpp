#include <poll.h>
#include <sys/ioctl.h>
#include <termios.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <memory>

#include "core/base/error.h"
#include "core/sim/run_phase.h"
#include "launch/command/command.h"
#include "launch/command/common_options.h"
#include "launch/process/status_table.h"
#include "launch/process/status_watch.h"
#include "nodes/runtime/observability/status.h"
#include "nodes/runtime/process/event.h"

namespace dmise {
namespace {

struct StatusOptions {
  std::string master, keys;
  bool once = false, watch = false, healthy = false;
};

constexpr double status_within_s = 2.0;
constexpr auto interval = std::chrono::milliseconds(500);

Security security_of(const StatusOptions& options) { return {options.keys, operator_name}; }

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
        run.take(ask_master(options.master, status_within_s, security), seconds_now());
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
  RunStatus status = ask_master(options.master, status_within_s, security);
  if (options.healthy) {
    if (!healthy(status)) throw Error(status.cause.empty() ? "a node is lost" : status.cause);
    return;
  }
  if (options.once || !isatty(STDOUT_FILENO)) {
    std::fputs(status_table(status).c_str(), stdout);
    return;
  }
  watch(options, security, status);
}

void add_status_options(CLI::App& command) {
  auto options = std::make_shared<StatusOptions>();
  add_master_option(command, "master", options->master)->required();
  command.add_option("--keys", options->keys, "directory with operator.key");
  auto* once = command.add_flag("--once", options->once, "print once, also on a terminal");
  command
      .add_flag("--watch", options->watch,
                "a live table until the run ends, q or Ctrl-C, as on a terminal without --once; "
                "elsewhere it is printed once")
      ->excludes(once);
  command.add_flag("--healthy", options->healthy,
                   "print nothing; exit with 0 if the run has not failed and no node is lost");
  command.callback([options] { show(*options); });
}

}  // namespace

Command status_command() {
  return {.group = CommandGroup::networks,
          .summary = "Shows the clock and nodes of a run; live on a terminal",
          .add_options = add_status_options};
}

}  // namespace dmise
