#include <poll.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>

#include "core/base/error.h"
#include "core/base/memory.h"
#include "core/base/printable.h"
#include "launch/command/command.h"
#include "nodes/runtime/program/command_line.h"
#include "nodes/runtime/program/version_text.h"

namespace dmise {
namespace {

/// Returns `code`, or 1 with a line on stderr if what was printed could not be written. A reader
/// that went away (`| head`) is no error.
int after_output(int code) {
  errno = 0;
  const bool failed = std::fflush(stdout) != 0 || std::ferror(stdout);
  const int reason = errno;  // 0 if an earlier piece failed
  pollfd output{.fd = STDOUT_FILENO, .events = 0, .revents = 0};
  const bool reader_gone = poll(&output, 1, 0) > 0 && (output.revents & POLLERR);
  if (code != 0 || !failed || reader_gone) return code;
  std::fprintf(stderr, "dmise: standard output can't be written%s%s\n", reason ? ": " : "",
               reason ? std::strerror(reason) : "");
  return 1;
}

int run(int argc, char** argv) {
  return_large_blocks();
  CLI::App app{"Simulates a network of optical sensors that watch near-Earth space.", "dmise"};
  app.set_version_flag("--version", version_text("dmise"));
  app.require_subcommand(1);
  add_commands(app, commands());
  want_decimal_numbers(app);
  constexpr std::size_t longest = 4000;  // length of an error message [bytes]
  try {
    app.parse(argc, argv);
    return 0;
  } catch (const CLI::ParseError& e) {
    return end_of_command_line(app, e);
  } catch (const ExitWith& e) {
    return e.code;
  } catch (const std::exception& e) {
    std::fprintf(stderr, "dmise: %s\n", printable(e.what(), longest).c_str());
    return dynamic_cast<const ConfigError*>(&e) ? 2 : 1;
  }
}

}  // namespace
}  // namespace dmise

int main(int argc, char** argv) {
  // A file that grows beyond the limit of ulimit -f is an error of its writer, with a message.
  std::signal(SIGXFSZ, SIG_IGN);
  return dmise::after_output(dmise::run(argc, argv));
}
