#pragma once
#include <sys/types.h>

#include <string>
#include <vector>

namespace dmise {

/// A program to start as a child, which does not outlive the thread that starts it.
struct Spawn {
  std::string name;                    // for messages
  std::vector<std::string> arguments;  // the first is the program's path
  std::string log_path = {};           // where its output goes; empty: stderr of this process
  bool keep_log = false;               // appends to it
  std::string directory = {};          // in which it runs; empty: that of this process
  std::vector<std::string> environment = {};  // NAME=VALUE, beside those of this process
  bool own_group = false;  // is in a process group of its own: Ctrl-C does not reach it
};

/// Starts the program. Throws `Error` if that is not possible.
pid_t spawn(const Spawn& what);

/// Pointers to words for execv, ended by null, as long as the words live.
std::vector<char*> pointers_to(std::vector<std::string>& words);

}  // namespace dmise
