#include "bench/process_family.h"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <optional>
#include <sstream>

namespace dmise {
namespace {

namespace fs = std::filesystem;

std::string read_proc(pid_t pid, const char* file) {
  std::ifstream in("/proc/" + std::to_string(pid) + "/" + file);
  std::ostringstream text;
  text << in.rdbuf();
  return std::move(text).str();
}

struct Stat {
  pid_t parent = 0;
  double cpu_s = 0.0;
};

std::optional<Stat> stat_of(pid_t pid) {
  const std::string text = read_proc(pid, "stat");
  const auto name_end = text.rfind(')');
  if (name_end == std::string::npos) return std::nullopt;
  std::istringstream fields(text.substr(name_end + 1));
  std::string state, skipped;
  Stat stat;
  fields >> state >> stat.parent;
  for (int i = 5; i <= 13; ++i) fields >> skipped;  // to utime, field 14 of proc(5)
  double user = 0, system = 0;
  fields >> user >> system;
  stat.cpu_s = (user + system) / double(sysconf(_SC_CLK_TCK));
  return stat;
}

/// A line "Key:   123 kB" of `text` in MB; 0 if there is none.
double megabytes(const std::string& text, const std::string& key) {
  const auto at = text.find("\n" + key + ":");
  if (at == std::string::npos) return 0.0;
  return std::strtod(text.c_str() + at + key.size() + 2, nullptr) * 1024e-6;
}

std::string name_of(pid_t pid) {
  const std::string line = read_proc(pid, "cmdline");
  const std::string flag("--name\0", 7);
  if (const auto at = line.find(flag); at != std::string::npos) return line.c_str() + at + 7;
  return fs::path(line.c_str()).filename();
}

std::map<pid_t, Stat> all_processes() {
  std::map<pid_t, Stat> all;
  std::error_code ignored;
  for (const auto& entry : fs::directory_iterator("/proc", ignored)) {
    const auto pid = pid_t(std::strtol(entry.path().filename().c_str(), nullptr, 10));
    if (const auto stat = pid > 0 ? stat_of(pid) : std::nullopt) all[pid] = *stat;
  }
  return all;
}

void look_at(pid_t pid, ProcessUse& use) {
  if (use.name.empty()) use.name = name_of(pid);
  const std::string memory = read_proc(pid, "smaps_rollup");
  use.pss_mb = megabytes(memory, "Pss");
  use.peak_pss_mb = std::max(use.peak_pss_mb, use.pss_mb);
  if (use.pss_mb == 0.0) return;  // it has just ended
  const double shared_mb = megabytes(memory, "Rss") - use.pss_mb;
  use.max_pss_mb =
      std::max(use.peak_pss_mb, megabytes(read_proc(pid, "status"), "VmHWM") - shared_mb);
}

}  // namespace

void ProcessFamily::update() {
  const auto processes = all_processes();
  const auto belongs = [&](pid_t pid) {
    for (auto at = processes.find(pid); at != processes.end();
         at = processes.find(at->second.parent))
      if (at->first == parent_) return true;
    return false;
  };
  pss_mb_ = 0.0;
  for (const auto& [pid, stat] : processes) {
    if (!belongs(pid)) continue;
    ProcessUse& use = members_[pid];
    use.cpu_s = stat.cpu_s;
    look_at(pid, use);
    pss_mb_ += use.pss_mb;
  }
  peak_pss_mb_ = std::max(peak_pss_mb_, pss_mb_);
}

double ProcessFamily::cpu_s() const {
  double seconds = 0.0;
  for (const auto& [pid, use] : members_) seconds += use.cpu_s;
  return seconds;
}

std::vector<ProcessUse> ProcessFamily::members() const {
  std::vector<ProcessUse> all;
  for (const auto& [pid, use] : members_) all.push_back(use);
  return all;
}

}  // namespace dmise
