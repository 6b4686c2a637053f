#include "launch/process/supervisor.h"

#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <thread>

#include "core/base/error.h"
#include "nodes/runtime/process/last_line.h"

namespace dmise {
namespace {

using Milliseconds = std::chrono::milliseconds;

}  // namespace

Supervisor::~Supervisor() { stop(Milliseconds(1000)); }

void Supervisor::start(const std::string& name, const std::vector<std::string>& arguments,
                       const std::string& log_path) {
  children_.push_back({.name = name,
                       .arguments = arguments,
                       .pid = spawn({.name = name, .arguments = arguments, .log_path = log_path}),
                       .exit_code = std::nullopt,
                       .log_path = log_path});
}

const Child* Supervisor::find(const std::string& name) const {
  for (const auto& child : children_)
    if (child.name == name) return &child;
  return nullptr;
}

void Supervisor::restart(const std::string& name) {
  for (std::size_t i = 0; i < children_.size(); ++i) {
    Child& child = children_[i];
    if (child.name != name) continue;
    if (!child.exit_code) {
      kill(child.pid, SIGKILL);
      while (waitpid(child.pid, nullptr, 0) < 0 && errno == EINTR) {
      }
      child.exit_code = killed_by + SIGKILL;  // should the next line fail
    }
    child.pid = spawn(
        {.name = name, .arguments = child.arguments, .log_path = child.log_path, .keep_log = true});
    child.exit_code.reset();
    if (first_failure_ == i) first_failure_.reset();
    ++child.starts;
  }
}

bool Supervisor::poll() {
  bool running = false;
  for (std::size_t i = 0; i < children_.size(); ++i) {
    auto& child = children_[i];
    if (child.exit_code) continue;
    int status = 0;
    if (waitpid(child.pid, &status, WNOHANG) != child.pid) {
      running = true;
      continue;
    }
    child.exit_code = WIFEXITED(status) ? WEXITSTATUS(status) : killed_by + WTERMSIG(status);
    if (*child.exit_code != 0 && !first_failure_) first_failure_ = i;
  }
  return running;
}

void Supervisor::stop(Milliseconds patience) {
  const auto send = [this](int signal) {
    for (const auto& child : children_)
      if (!child.exit_code) kill(child.pid, signal);
  };
  if (!poll()) return;
  send(SIGTERM);
  const auto deadline = std::chrono::steady_clock::now() + patience;
  while (poll() && std::chrono::steady_clock::now() < deadline)
    std::this_thread::sleep_for(Milliseconds(5));
  send(SIGKILL);
  while (poll()) std::this_thread::sleep_for(Milliseconds(5));
}

const Child* Supervisor::first_failure() const {
  return first_failure_ ? &children_[*first_failure_] : nullptr;
}

std::string end_of(const Child& child) {
  const int code = child.exit_code.value_or(0);
  if (code > killed_by) return child.name + " was killed (" + strsignal(code - killed_by) + ")";
  return child.name + ": " + last_line(child.log_path);
}

std::string program_directory() {
  std::error_code ignored;
  return std::filesystem::read_symlink("/proc/self/exe", ignored).parent_path().string();
}

void become(std::vector<std::string> command) {
  execv(command[0].c_str(), pointers_to(command).data());
  throw Error(command[0] + ": " + std::strerror(errno));
}

void become_program(const std::string& name, std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), program_directory() + "/" + name);
  become(std::move(arguments));
}

}  // namespace dmise
