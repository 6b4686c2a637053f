#pragma once
#include <sys/wait.h>
#include <unistd.h>

#include <functional>
#include <string>
#include <vector>

#include "core/base/error.h"

namespace dmise {

/// Child processes that each read one line of addresses from a pipe before they start.
class Children {
 public:
  Children(int count, const std::function<int(int index, const std::string& line)>& work) {
    for (int i = 0; i < count; ++i) {
      int ends[2];
      if (pipe(ends) != 0) throw Error("pipe: too many open files");
      const pid_t pid = fork();
      if (pid < 0) throw Error("fork: too many processes");
      if (pid == 0) {
        close(ends[1]);
        std::string line;
        for (char c; read(ends[0], &c, 1) == 1 && c != '\n';) line += c;
        _exit(work(i, line));
      }
      close(ends[0]);
      pids_.push_back(pid);
      pipes_.push_back(ends[1]);
    }
  }
  void send(const std::string& line) {
    for (int& end : pipes_) {
      if (write(end, (line + "\n").data(), line.size() + 1) < 0) throw Error("a child is gone");
      close(end);
    }
  }
  const std::vector<pid_t>& pids() const { return pids_; }
  ~Children() {
    for (const pid_t pid : pids_) waitpid(pid, nullptr, 0);
  }

 private:
  std::vector<pid_t> pids_;
  std::vector<int> pipes_;
};

}  // namespace dmise
