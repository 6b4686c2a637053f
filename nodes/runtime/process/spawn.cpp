#include "nodes/runtime/process/spawn.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

#include "core/base/error.h"
#include "core/base/files/regular_file.h"

namespace dmise {
namespace {

/// What a child needs between fork and exec, where it may not allocate.
struct Prepared {
  explicit Prepared(const Spawn& what)
      : arguments(what.arguments), environment(what.environment), parent(getpid()) {
    for (char** each = environ; *each; ++each) environment.emplace_back(*each);
    argument_pointers = pointers_to(arguments);
    environment_pointers = pointers_to(environment);
  }

  std::vector<std::string> arguments, environment;
  std::vector<char*> argument_pointers, environment_pointers;
  pid_t parent;
};

/// In the child: executes the program, or writes the error to `report`.
[[noreturn]] void become_child(const Spawn& what, const Prepared& prepared, int report) {
  prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (getppid() != prepared.parent) _exit(1);
  if (what.own_group) setpgid(0, 0);
  const int log = what.log_path.empty()
                      ? STDERR_FILENO
                      : open_own_file(what.log_path.c_str(),
                                      O_WRONLY | O_APPEND | (what.keep_log ? 0 : O_TRUNC));
  const int in = open("/dev/null", O_RDONLY);
  const bool there = what.directory.empty() || chdir(what.directory.c_str()) == 0;
  if (log >= 0 && in >= 0 && there) {
    dup2(in, STDIN_FILENO);
    dup2(log, STDOUT_FILENO);
    dup2(log, STDERR_FILENO);
    execve(prepared.argument_pointers[0], prepared.argument_pointers.data(),
           prepared.environment_pointers.data());
  }
  const int reason = errno;
  if (write(report, &reason, sizeof reason) < 0) _exit(126);
  _exit(127);
}

}  // namespace

pid_t spawn(const Spawn& what) {
  const Prepared prepared(what);
  int report[2];
  if (pipe2(report, O_CLOEXEC) != 0) throw Error(what.name + ": no pipe: " + std::strerror(errno));
  const pid_t pid = fork();
  if (pid < 0) {
    const int reason = errno;
    close(report[0]);
    close(report[1]);
    throw Error(what.name + ": can't start a process: " + std::strerror(reason));
  }
  if (pid == 0) become_child(what, prepared, report[1]);
  close(report[1]);
  int reason = 0;
  ssize_t got = 0;
  do {
    got = read(report[0], &reason, sizeof reason);
  } while (got < 0 && errno == EINTR);
  close(report[0]);
  if (got > 0) {
    waitpid(pid, nullptr, 0);
    throw Error(what.arguments[0] + ": can't be started: " + std::strerror(reason));
  }
  return pid;
}

std::vector<char*> pointers_to(std::vector<std::string>& words) {
  std::vector<char*> pointers;
  for (std::string& word : words) pointers.push_back(word.data());
  pointers.push_back(nullptr);
  return pointers;
}

}  // namespace dmise
