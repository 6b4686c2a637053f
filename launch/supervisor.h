#pragma once
#include <sys/types.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>

namespace dmise {

/// A child process and how it ended.
struct Child {
  std::string name;
  std::vector<std::string> arguments;
  pid_t pid = 0;
  int starts = 1;
  std::optional<int> exit_code;  // 128 + signal when killed by one
  std::string log_path;          // what it wrote to stderr
};

/// Starts the processes of a run and sees them all to their end: no child outlives it, also when it
/// is itself killed (PR_SET_PDEATHSIG).
class Supervisor {
 public:
  Supervisor() = default;
  ~Supervisor();
  Supervisor(const Supervisor&) = delete;
  Supervisor& operator=(const Supervisor&) = delete;

  /// `arguments[0]` is the program. Its stdout and stderr go to `log_path`. Throws `Error`.
  void start(const std::string& name, const std::vector<std::string>& arguments,
             const std::string& log_path);

  /// Starts a child that has ended, or kills one that has not and starts it, once more. Its log
  /// goes on.
  void restart(const std::string& name);

  /// Takes note of who has ended. True while somebody runs.
  bool poll();
  /// SIGTERM to all that run; SIGKILL to those that still do `patience` later.
  void stop(std::chrono::milliseconds patience);

  const std::vector<Child>& children() const { return children_; }
  /// Null when there is no child of that name.
  const Child* find(const std::string& name) const;
  /// The first child seen to end with a code other than 0.
  const Child* first_failure() const;

 private:
  pid_t spawn(const std::string& name, const std::vector<std::string>& arguments,
              const std::string& log_path, bool keep_log);

  std::vector<Child> children_;
  std::optional<std::size_t> first_failure_;
};

constexpr int killed_by = 128;  // codes above stand for signals

/// How a child has ended: "beta was killed (Killed)", or "beta: " and its last words.
std::string end_of(const Child& child);

/// The message of the last line of a log that is not empty.
std::string last_line(const std::string& path);

/// Directory of the running program.
std::string program_directory();

}  // namespace dmise
