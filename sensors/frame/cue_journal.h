#pragma once
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include "core/base/sim_time.h"
#include "core/products/task.h"

namespace dmise {

/// The tasks that a sensor was given, and the ticks that it has done, in `tasks.journal` of its
/// directory: a process that goes on with its work is not given them again. Lines; the last one
/// counts if it is whole. Methods throw `Error` "PATH: reason".
class CueJournal {
 public:
  explicit CueJournal(const std::string& directory);
  ~CueJournal();
  CueJournal(const CueJournal&) = delete;
  CueJournal& operator=(const CueJournal&) = delete;

  /// Starts an empty journal.
  void clear();
  /// Continues an existing journal. Returns its tasks by id, with the fields that a sensor needs.
  std::vector<std::shared_ptr<const Task>> resume();
  void add(const Task& task);
  /// The products of the tick are written.
  void end(Tick tick);

  /// The first tick that is not known to be done.
  static Tick ticks_done(const std::string& directory);

 private:
  void open(const char* mode);
  void write(const std::string& line);
  [[noreturn]] void fail(const std::string& reason) const;

  std::string path_;
  std::FILE* file_ = nullptr;
};

}  // namespace dmise
