#include "launch/process/run_lock.h"

#include <fcntl.h>
#include <signal.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <thread>

#include "core/base/error.h"
#include "core/base/files/paths.h"
#include "core/base/files/regular_file.h"
#include "core/base/formatted.h"
#include "core/base/printable.h"
#include "nodes/runtime/process/process_stat.h"

namespace dmise {
namespace {

using Clock_ = std::chrono::steady_clock;

std::string host_name() {
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  return host;
}

std::string utc_now() {
  const std::time_t now = std::time(nullptr);
  std::tm utc{};
  gmtime_r(&now, &utc);
  char text[32];
  std::strftime(text, sizeof text, "%Y-%m-%dT%H:%M:%SZ", &utc);
  return text;
}

std::string own_command() {
  std::ifstream file("/proc/self/cmdline", std::ios::binary);
  std::string text{std::istreambuf_iterator<char>(file), {}};
  while (!text.empty() && text.back() == '\0') text.pop_back();
  std::replace(text.begin(), text.end(), '\0', ' ');
  if (const auto slash = text.substr(0, text.find(' ')).rfind('/'); slash != std::string::npos)
    text.erase(0, slash + 1);
  constexpr std::size_t most = 400;
  return text.size() > most ? text.substr(0, most) + ".." : text;
}

std::string content_of(int fd) {
  std::string text(8192, '\0');
  const ssize_t n = pread(fd, text.data(), text.size(), 0);
  text.resize(n > 0 ? std::size_t(n) : 0);
  return text;
}

bool has_other_names(int fd) {
  struct stat open {};
  return fstat(fd, &open) == 0 && open.st_nlink > 1;
}

/// Whether the path still refers to the open file.
bool is_at(int fd, const std::string& path) {
  struct stat open {
  }, there{};
  return fstat(fd, &open) == 0 && stat(path.c_str(), &there) == 0 && open.st_ino == there.st_ino &&
         open.st_dev == there.st_dev;
}

/// Also of one whose parent has not yet taken notice, a zombie: proc(5).
bool has_ended(const LockHolder& holder) {
  if (holder.host != host_name()) return false;
  if (kill(pid_t(holder.pid), 0) != 0 && errno == ESRCH) return true;
  const char state = process_state(pid_t(holder.pid));
  return state == 'Z' || state == 'X';
}

}  // namespace

LockHolder this_process() {
  return {.host = host_name(),
          .pid = getpid(),
          .since_utc = utc_now(),
          .command = own_command(),
          .run_id = 0};
}

std::string lock_text(const LockHolder& h) {
  const nlohmann::ordered_json json{
      {"host", h.host},
      {"pid", h.pid},
      {"since", h.since_utc},
      {"command", h.command},
      {"run", formatted("%016llx", static_cast<unsigned long long>(h.run_id))}};
  return json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace) + "\n";
}

std::optional<LockHolder> parse_lock(const std::string& text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  try {
    LockHolder h;
    json.at("host").get_to(h.host);
    json.at("since").get_to(h.since_utc);
    json.at("command").get_to(h.command);
    if (!json.at("pid").is_number_integer()) return std::nullopt;
    json.at("pid").get_to(h.pid);
    h.run_id = std::strtoull(json.at("run").get<std::string>().c_str(), nullptr, 16);
    return h.pid > 0 ? std::optional(h) : std::nullopt;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

std::string describe(const LockHolder& holder) {
  return printable("pid " + std::to_string(holder.pid) + " on " + holder.host + " since " +
                   holder.since_utc + ": " + holder.command);
}

RunLock::RunLock(const std::string& directory, double patience_s)
    : path_(directory + "/.run-lock"), self_(this_process()) {
  const auto deadline = Clock_::now() + std::chrono::duration<double>(patience_s);
  while (!try_to_take(directory, Clock_::now() >= deadline))
    std::this_thread::sleep_for(std::chrono::milliseconds(50));
}

RunLock::~RunLock() {
  if (file_ && is_at(file_->descriptor(), path_)) unlink(path_.c_str());
}

bool RunLock::try_to_take(const std::string& directory, bool last) {
  // Without O_CLOEXEC: the run's processes hold the lock too.
  const int fd = open_own_file(path_.c_str(), O_RDWR);
  if (fd < 0) throw Error(directory + ": can't be written: " + std::strerror(errno));
  FileLock file(fd);
  if (has_other_names(fd)) throw Error(path_ + ": is a file of another name, too");
  bool taken = false;
  try {
    taken = file.take();
  } catch (const Error& error) {
    throw Error(directory + ": " + error.what() + ", and a run needs to lock its directory");
  }
  if (!taken) {
    const auto holder = parse_lock(content_of(fd));
    const bool left = holder && has_ended(*holder);
    if ((left || !holder) && !last) return false;
    throw ConfigError(directory + ": is in use by " + (left ? "processes left by " : "") +
                      (holder ? describe(*holder) : "a run that has just begun"));
  }
  if (!is_at(fd, path_)) return false;  // its holder has just removed it
  file_.emplace(std::move(file));
  if (write_holder()) return true;
  const int reason = errno;
  unlink(path_.c_str());
  throw Error(directory + ": can't be written: " + std::strerror(reason));
}

bool RunLock::write_holder() {
  const std::string text = lock_text(self_);
  errno = ENOSPC;
  return ftruncate(file_->descriptor(), off_t(text.size())) == 0 &&
         pwrite(file_->descriptor(), text.data(), text.size(), 0) == ssize_t(text.size());
}

void RunLock::set_run_id(std::uint64_t run_id) {
  if (self_.run_id == run_id) return;
  self_.run_id = run_id;
  write_holder();
}

void RunLock::release_to_exec() {
  file_->leave_open();
  file_.reset();
}

std::optional<LockHolder> RunLock::written_in(const std::string& directory) {
  const int fd =
      open((directory + "/.run-lock").c_str(), O_RDONLY | O_CLOEXEC | O_NOFOLLOW | O_NONBLOCK);
  if (fd < 0) return std::nullopt;
  const std::string text = content_of(fd);
  close(fd);
  return parse_lock(text);
}

std::unique_ptr<RunLock> lock_directory(const std::string& directory) {
  make_directories(directory);
  return std::make_unique<RunLock>(directory);
}

}  // namespace dmise
