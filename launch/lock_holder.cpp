#include "launch/lock_holder.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <ctime>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <random>
#include <sstream>

#include "core/base/formatted.h"

namespace dmise {
namespace {

std::string first_line(const std::string& path) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  return line;
}

/// Name of the current pid namespace.
std::string pid_namespace() {
  char name[64];
  const ssize_t n = readlink("/proc/self/ns/pid", name, sizeof name);
  return n > 0 ? std::string(name, std::size_t(n)) : std::string();
}

struct ProcessStat {
  char state = '?';
  std::uint64_t start = 0;  // [clock ticks since boot]
};

/// proc(5): the program's name, in parentheses, may contain any character.
std::optional<ProcessStat> stat_of(std::int64_t pid) {
  const std::string text = first_line("/proc/" + std::to_string(pid) + "/stat");
  const auto end = text.rfind(')');
  if (end == std::string::npos) return std::nullopt;
  std::istringstream fields(text.substr(end + 1));
  ProcessStat stat;
  std::string skipped;
  fields >> stat.state;
  constexpr int before_start = 18;  // fields between the fourth, ppid, and the 22nd
  for (int i = 0; i < before_start; ++i) fields >> skipped;
  if (!(fields >> stat.start)) return std::nullopt;
  return stat;
}

bool process_has_ended(const LockHolder& holder, LockSight::KernelLock kernel_lock) {
  if (const auto stat = stat_of(holder.pid))
    return stat->start != holder.start || stat->state == 'Z' || stat->state == 'X';
  if (kill(pid_t(holder.pid), 0) != 0 && errno == ESRCH) return true;
  // The process, or another with its pid, belongs to another user, and /proc hides it.
  return holder.kernel_lock && kernel_lock == LockSight::KernelLock::free;
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

}  // namespace

std::string random_token() {
  std::random_device random;
  return formatted("%08x%08x%08x%08x", random(), random(), random(), random());
}

LockHolder this_process() {
  LockHolder self;
  char host[256] = "";
  gethostname(host, sizeof host - 1);
  self.host = host;
  self.machine = first_line("/etc/machine-id");
  self.boot = first_line("/proc/sys/kernel/random/boot_id");
  self.pid_namespace = pid_namespace();
  self.pid = getpid();
  if (const auto stat = stat_of(self.pid)) self.start = stat->start;
  self.since_utc = utc_now();
  self.command = own_command();
  self.token = random_token();
  return self;
}

std::string lock_text(const LockHolder& h) {
  const std::string run = formatted("%016llx", static_cast<unsigned long long>(h.run_id));
  const nlohmann::ordered_json json{{"host", h.host},
                                    {"machine", h.machine},
                                    {"boot", h.boot},
                                    {"pid", h.pid},
                                    {"pid_namespace", h.pid_namespace},
                                    {"start", h.start},
                                    {"since", h.since_utc},
                                    {"command", h.command},
                                    {"token", h.token},
                                    {"kernel_lock", h.kernel_lock},
                                    {"run", run}};
  return json.dump(-1, ' ', true, nlohmann::json::error_handler_t::replace) + "\n";
}

std::optional<LockHolder> parse_lock(const std::string& text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  if (!json.is_object()) return std::nullopt;
  try {
    LockHolder h;
    json.at("host").get_to(h.host);
    json.at("machine").get_to(h.machine);
    json.at("boot").get_to(h.boot);
    json.at("pid_namespace").get_to(h.pid_namespace);
    json.at("since").get_to(h.since_utc);
    json.at("command").get_to(h.command);
    json.at("token").get_to(h.token);
    json.at("kernel_lock").get_to(h.kernel_lock);
    if (!json.at("pid").is_number_integer() || !json.at("start").is_number_unsigned())
      return std::nullopt;
    json.at("pid").get_to(h.pid);
    json.at("start").get_to(h.start);
    h.run_id = std::strtoull(json.at("run").get<std::string>().c_str(), nullptr, 16);
    if (h.pid <= 0 || h.token.empty()) return std::nullopt;
    return h;
  } catch (const nlohmann::json::exception&) {
    return std::nullopt;
  }
}

std::string describe(const LockHolder& holder) {
  std::string text = "pid " + std::to_string(holder.pid) + " on " + holder.host + " since " +
                     holder.since_utc + ": " + holder.command;
  for (char& c : text)
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) c = '?';
  return text;
}

bool has_ended(const LockHolder& holder, const LockHolder& self, const LockSight& sight) {
  using enum LockSight::KernelLock;
  if (sight.kernel_lock == held) return false;
  if (!holder.boot.empty() && holder.boot == self.boot) {
    if (holder.pid_namespace == self.pid_namespace)
      return process_has_ended(holder, sight.kernel_lock);
    // In another container of this kernel, where its pid is meaningless here.
    if (holder.kernel_lock && sight.kernel_lock == free) return true;
  } else if (holder.host == self.host && holder.machine == self.machine &&
             sight.age_s > sight.uptime_s) {
    return true;  // last touched before this machine started
  }
  // A time in the future is useless: the file system's clock was set back.
  return sight.age_s > lock_silent_s || (sight.age_s < 0.0 && sight.watched_s > 2 * lock_beat_s);
}

}  // namespace dmise
