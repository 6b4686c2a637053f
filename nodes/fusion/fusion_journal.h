#pragma once
#include <cstdio>
#include <functional>
#include <span>
#include <string>

#include "core/sim/message.h"

namespace dmise {

/// The inputs of a fusion node tick by tick, so that a process that goes on with a run does the
/// earlier ticks again. Each message has its check sum; a tick counts once its end is written.
/// Methods throw `Error` "PATH: reason".
class FusionJournal {
 public:
  explicit FusionJournal(std::string path) : path_(std::move(path)) {}
  ~FusionJournal();
  FusionJournal(const FusionJournal&) = delete;
  FusionJournal& operator=(const FusionJournal&) = delete;

  /// Begins anew.
  void clear();
  /// Calls `again` for each tick before `tick` and goes on behind them. Throws `Error` if the
  /// journal does not reach so far.
  void resume(Tick tick, const std::function<void(Tick, std::span<const Message>)>& again);
  void add(std::span<const Message> inputs);
  /// Everything of the tick is written.
  void end(Tick tick);

  /// The first tick that a journal does not have.
  static Tick ticks_written(const std::string& path);

 private:
  void open(const char* mode);
  [[noreturn]] void fail(const std::string& reason) const;

  std::string path_;
  std::FILE* file_ = nullptr;
};

}  // namespace dmise
