#pragma once
#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

#include "nodes/runtime/process/spawn.h"

namespace dmise {

/// A child process and how it ended.
struct Child {
  std::string name;
  std::vector<std::string> arguments;
  pid_t pid = 0;
  int starts = 1;
  std::optional<int> exit_code;  // 128 + signal if killed
  std::string log_path;          // its stderr
};

/// Starts the processes of a run and waits for their end: no child outlives it, also if it is
/// killed (PR_SET_PDEATHSIG).
class Supervisor {
 public:
  Supervisor() = default;
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// `arguments[0]` is the program. Its stdout and stderr go to `log_path`. Throws `Error`.
  void start(const std::string& name, const std::vector<std::string>& arguments,
             const std::string& log_path);

  /// Restarts a child, killing it if it is still running. Its log continues.
  void restart(const std::string& name);

  /// Reaps children that have ended. True while any is running.
  bool poll();
  /// Sends SIGTERM to all running children, and SIGKILL to those still running `patience` later.
  void stop(std::chrono::milliseconds patience);

  const std::vector<Child>& children() const { return children_; }
  /// Null if there is no child of that name.
  const Child* find(const std::string& name) const;
  /// The first child found to have ended with a code other than 0.
  const Child* first_failure() const;

 private:
  std::vector<Child> children_;
  std::optional<std::size_t> first_failure_;
};

constexpr int killed_by = 128;  // codes above are signals

/// How a child has ended: "beta was killed (Killed)", or "beta: " and its last line.
std::string end_of(const Child& child);

/// Directory of the running program.
std::string program_directory();

/// Replaces this process by the program `command[0]`. Throws `Error` if it cannot be started.
[[noreturn]] void become(std::vector<std::string> command);
/// Becomes a program of `program_directory`.
[[noreturn]] void become_program(const std::string& name, std::vector<std::string> arguments);

}  // namespace dmise
