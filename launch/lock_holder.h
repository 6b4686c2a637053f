#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace dmise {

/// The process that a run directory is locked by, as its lock file tells it.
struct LockHolder {
  std::string host;           // name of the machine or container
  std::string machine;        // /etc/machine-id; empty where there is none
  std::string boot;           // the kernel's random id of its boot
  std::string pid_namespace;  // process ids mean something within one alone
  std::int64_t pid = 0;
  std::uint64_t start = 0;  // of the process [clock ticks since boot]: tells a pid used again
  std::string since_utc, command;
  std::string token;         // random, of this lock alone
  bool kernel_lock = false;  // the file is also locked by fcntl
  std::uint64_t run_id = 0;  // of the time-master, once it is known; 0: none or not yet
};

/// This process.
LockHolder this_process();

/// One line of JSON; its length does not depend on `run_id`.
std::string lock_text(const LockHolder& holder);
/// Nothing when the text is not that of a whole lock.
std::optional<LockHolder> parse_lock(const std::string& text);

/// "pid 123 on HOST since 2018-01-21T00:15:00Z: COMMAND", control characters as '?'.
std::string describe(const LockHolder& holder);

/// What is seen of a lock file, beside what it says.
struct LockSight {
  double age_s = 0.0;  // since it was last touched, by the file system's clock
  enum class KernelLock { held, free, unknown } kernel_lock = KernelLock::unknown;
  double uptime_s = 0.0;   // of the machine that looks
  double watched_s = 0.0;  // for so long it was looked at and not touched
};

/// Whether the holder has ended for certain. `self` is the process that looks. A process of this
/// kernel is asked of the kernel; one of another host counts as ended when it has not touched its
/// lock for `lock_silent_s`, one of this host's earlier boot at once.
bool has_ended(const LockHolder& holder, const LockHolder& self, const LockSight& sight);

constexpr double lock_beat_s = 5.0;     // how often a holder touches its lock
constexpr double lock_silent_s = 60.0;  // a holder on another host that is not heard for so long

}  // namespace dmise
