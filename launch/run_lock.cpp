#include "launch/run_lock.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <time.h>
#include <unistd.h>

#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <utility>

#include "core/base/error.h"
#include "core/base/paths.h"

namespace dmise {
namespace {

using Clock_ = std::chrono::steady_clock;
using KernelLock = LockSight::KernelLock;

/// A file descriptor that closes itself.
class File {
 public:
  explicit File(int fd) : fd_(fd) {}
  ~File() {
    if (fd_ >= 0) close(fd_);
  }
  File(const File&) = delete;
  File& operator=(const File&) = delete;
  explicit operator bool() const { return fd_ >= 0; }
  int get() const { return fd_; }
  int release() { return std::exchange(fd_, -1); }

 private:
  int fd_;
};

/// fcntl(2), open file description locks: owned by the open file and inherited.
struct flock whole_file() {
  struct flock whole {};
  whole.l_type = F_WRLCK;
  whole.l_whence = SEEK_SET;
  return whole;
}

KernelLock look_at_kernel_lock(int fd) {
  struct flock whole = whole_file();
  if (fcntl(fd, F_OFD_GETLK, &whole) != 0) return KernelLock::unknown;
  return whole.l_type == F_UNLCK ? KernelLock::free : KernelLock::held;
}

/// Empty if the file system does not support such locks.
std::optional<bool> take_kernel_lock(int fd) {
  struct flock whole = whole_file();
  if (fcntl(fd, F_OFD_SETLK, &whole) == 0) return true;
  if (errno == EAGAIN || errno == EACCES) return false;
  return std::nullopt;
}

void write_whole(int fd, const std::string& text, const std::string& path) {
  const ssize_t n = pwrite(fd, text.data(), text.size(), 0);
  if (n != ssize_t(text.size()) || fsync(fd) != 0)
    throw Error(path + ": can't be written: " +
                std::strerror(n < 0 || n == ssize_t(text.size()) ? errno : ENOSPC));
}

std::string content_of(int fd) {
  std::string text(8192, '\0');
  const ssize_t n = pread(fd, text.data(), text.size(), 0);
  text.resize(n > 0 ? std::size_t(n) : 0);
  return text;
}

bool same_file(const struct stat& a, const struct stat& b) {
  return a.st_ino == b.st_ino && a.st_dev == b.st_dev;
}

/// Whether the path still refers to the open file.
bool is_at(int fd, const std::string& path) {
  struct stat open {
  }, there{};
  return fstat(fd, &open) == 0 && stat(path.c_str(), &there) == 0 && same_file(open, there);
}

double seconds(const timespec& t) { return double(t.tv_sec) + 1e-9 * double(t.tv_nsec); }

double uptime_s() {
  timespec up{};
  clock_gettime(CLOCK_BOOTTIME, &up);
  return seconds(up);
}

/// Touches `fd` and returns the file system's time.
double update_mtime(int fd) {
  futimens(fd, nullptr);
  struct stat now {};
  fstat(fd, &now);
  return seconds(now.st_mtim);
}

/// Links `path` to the file `made` unless it exists. Over a network the answer may be lost, but not
/// the link.
bool link_new(const std::string& made, const std::string& path, int fd) {
  if (link(made.c_str(), path.c_str()) == 0) return true;
  const int reason = errno;
  if (is_at(fd, path)) return true;
  if (reason == EEXIST) return false;
  if (reason == EPERM || reason == EOPNOTSUPP || reason == ENOSYS || reason == EMLINK) {
    // No hard links: the creator of the empty file replaces it by the complete one.
    const File placed(open(path.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, 0644));
    if (!placed && errno == EEXIST) return false;
    if (placed && rename(made.c_str(), path.c_str()) == 0) return true;
  }
  throw Error(path + ": can't be created: " + std::strerror(errno));
}

}  // namespace

RunLock::RunLock(std::string directory, std::function<void(const std::string&)> on_loss,
                 double patience_s)
    : directory_(std::move(directory)),
      path_(directory_ + "/.run-lock"),
      self_(this_process()),
      on_loss_(std::move(on_loss)) {
  const auto deadline = Clock_::now() + std::chrono::duration<double>(patience_s);
  Watch watch{.touched = 0.0, .since = Clock_::now()};
  while (!try_to_take(watch, Clock_::now() >= deadline))
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
  // Signals are handled by the threads that wait for them.
  sigset_t all, before;
  sigfillset(&all);
  pthread_sigmask(SIG_SETMASK, &all, &before);
  beating_ = std::thread([this] { beat(); });
  pthread_sigmask(SIG_SETMASK, &before, nullptr);
}

RunLock::~RunLock() {
  if (fd_ < 0) return;
  {
    std::lock_guard lock(mutex_);
    ending_ = true;
  }
  woken_.notify_one();
  beating_.join();
  if (is_at(fd_, path_)) unlink(path_.c_str());
  close(fd_);
}

/// False to try again; `last`: throws instead.
bool RunLock::try_to_take(Watch& watch, bool last) {
  const std::string made = path_ + "." + self_.token;
  // Without O_CLOEXEC: the run's processes hold the lock too.
  File file(open(made.c_str(), O_RDWR | O_CREAT | O_EXCL, 0644));
  if (!file) throw Error(directory_ + ": can't be written: " + std::strerror(errno));
  struct Removal {
    const std::string& path;
    ~Removal() { unlink(path.c_str()); }
  } removal{made};
  self_.kernel_lock = take_kernel_lock(file.get()).value_or(false);
  write_whole(file.get(), lock_text(self_), directory_);
  if (link_new(made, path_, file.get())) {
    fd_ = file.release();
    return true;
  }

  const File other(open(path_.c_str(), O_RDWR | O_CLOEXEC));
  if (!other) {
    if (errno == ENOENT) return false;  // just released
    throw Error(path_ + ": can't be opened: " + std::strerror(errno));
  }
  struct stat seen {};
  fstat(other.get(), &seen);
  if (const double touched = seconds(seen.st_mtim); touched != watch.touched)
    watch = {.touched = touched, .since = Clock_::now()};
  const LockSight sight{
      .age_s = update_mtime(file.get()) - watch.touched,
      .kernel_lock = look_at_kernel_lock(other.get()),
      .uptime_s = uptime_s(),
      .watched_s = std::chrono::duration<double>(Clock_::now() - watch.since).count()};
  const auto holder = parse_lock(content_of(other.get()));
  if (!holder) {
    // It is being created, or was truncated by a power failure.
    const bool old = sight.age_s > std::min(lock_silent_s, sight.uptime_s);
    if (sight.kernel_lock == KernelLock::held || !old) {
      if (!last) return false;
      throw ConfigError(directory_ + ": is in use: " + path_ + " exists without a holder");
    }
  } else if (!has_ended(*holder, self_, sight)) {
    LockSight of_itself = sight;
    of_itself.kernel_lock = KernelLock::unknown;
    const bool orphans = sight.kernel_lock == KernelLock::held && holder->boot == self_.boot &&
                         has_ended(*holder, self_, of_itself);
    const bool watching = sight.age_s < 0.0 && holder->boot != self_.boot;
    if ((orphans || watching) && !last) return false;
    throw ConfigError(directory_ + ": is in use by " + (orphans ? "processes left by " : "") +
                      describe(*holder));
  }
  // One process at a time takes it over: after locking the old file it checks that it is still in
  // place.
  const auto taken = take_kernel_lock(other.get());
  if ((taken && !*taken) || !is_at(other.get(), path_)) {
    if (!last) return false;
    throw ConfigError(directory_ + ": is in use: another process is taking it over");
  }
  if (rename(made.c_str(), path_.c_str()) != 0)
    throw Error(path_ + ": can't be replaced: " + std::strerror(errno));
  // Without kernel locks another process may have replaced it too: the last one wins.
  if (!taken) std::this_thread::sleep_for(std::chrono::seconds(1));
  if (!is_at(file.get(), path_)) return false;
  fd_ = file.release();
  return true;
}

void RunLock::beat() {
  std::unique_lock lock(mutex_);
  while (!ending_) {
    woken_.wait_for(lock, std::chrono::duration<double>(lock_beat_s), [this] { return ending_; });
    if (ending_) return;
    if (const std::string line = loss(); !line.empty()) {
      lock.unlock();
      return on_loss_(line);
    }
    futimens(fd_, nullptr);
  }
}

/// Empty while the lock is held. A failed check is repeated later.
std::string RunLock::loss() const {
  struct stat mine {
  }, there{};
  if (fstat(fd_, &mine) != 0) return "";
  if (stat(path_.c_str(), &there) != 0)
    return errno == ENOENT ? path_ + ": was removed during the run" : "";
  if (same_file(mine, there)) return "";
  const File file(open(path_.c_str(), O_RDONLY | O_CLOEXEC));
  const auto holder = file ? parse_lock(content_of(file.get())) : std::nullopt;
  return directory_ + ": was taken by " + (holder ? describe(*holder) : "another process") +
         " while this run was suspended";
}

void RunLock::set_run_id(std::uint64_t run_id) {
  if (self_.run_id == run_id) return;
  self_.run_id = run_id;
  const std::string text = lock_text(self_);  // same length as the text it replaces
  [[maybe_unused]] const ssize_t n = pwrite(fd_, text.data(), text.size(), 0);
}

void RunLock::release_to_exec() {
  {
    std::lock_guard lock(mutex_);
    ending_ = true;
  }
  woken_.notify_one();
  if (beating_.joinable()) beating_.join();
  fd_ = -1;
}

std::optional<LockHolder> RunLock::written_in(const std::string& directory) {
  const File file(open((directory + "/.run-lock").c_str(), O_RDONLY | O_CLOEXEC));
  return file ? parse_lock(content_of(file.get())) : std::nullopt;
}

std::unique_ptr<RunLock> lock_directory(const std::string& directory) {
  make_directories(directory);
  return std::make_unique<RunLock>(directory);
}

void RunLock::end_process(const std::string& line) {
  std::fprintf(stderr, "dmise: %s\n", line.c_str());
  std::_Exit(1);
}

}  // namespace dmise
