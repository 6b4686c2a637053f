#pragma once
#include <cstdint>
#include <optional>
#include <string>

namespace dmise {

/// The process that holds the lock of a run directory, as written in its lock file.
struct LockHolder {
  std::string host;           // name of the machine or container
  std::string machine;        // /etc/machine-id; empty where there is none
  std::string boot;           // the kernel's random id of its boot
  std::string pid_namespace;  // process ids are valid only within it
  std::int64_t pid = 0;
  std::uint64_t start = 0;  // of the process [clock ticks since boot]: detects a reused pid
  std::string since_utc, command;
  std::string token;         // random, unique to this lock
  bool kernel_lock = false;  // the file is also locked by fcntl
  std::uint64_t run_id = 0;  // of the time-master; 0: not yet known
};

/// This process.
LockHolder this_process();

/// 32 hexadecimal digits from the kernel's random numbers.
std::string random_token();

/// One line of JSON with a length independent of `run_id`.
std::string lock_text(const LockHolder& holder);
/// Parses a lock file; empty if it is incomplete.
std::optional<LockHolder> parse_lock(const std::string& text);

/// "pid 123 on HOST since 2018-01-21T00:15:00Z: COMMAND", control characters as '?'.
std::string describe(const LockHolder& holder);

/// State of a lock file besides its content.
struct LockSight {
  double age_s = 0.0;  // since last touched, by the file system's clock
  enum class KernelLock { held, free, unknown } kernel_lock = KernelLock::unknown;
  double uptime_s = 0.0;   // of this machine
  double watched_s = 0.0;  // time observed without a touch
};

/// Whether the holder has certainly ended. `self` is this process. For a process of this kernel the
/// kernel decides; one of another host has ended if it has not touched its lock for
/// `lock_silent_s`, one of an earlier boot of this host at once.
bool has_ended(const LockHolder& holder, const LockHolder& self, const LockSight& sight);

constexpr double lock_beat_s = 5.0;     // interval at which a holder touches its lock
constexpr double lock_silent_s = 60.0;  // silence after which a holder on another host has ended

}  // namespace dmise
