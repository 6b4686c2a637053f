#pragma once
#include <cstdio>
#include <functional>
#include <span>
#include <string>

#include "core/sim/message.h"

namespace dmise {

/// The inputs of a fusion node tick by tick, so that a process that continues a run can repeat the
/// earlier ticks. Each message has a checksum; a tick counts when its end is written. Methods throw
/// `Error` "PATH: reason".
class FusionJournal {
 public:
  explicit FusionJournal(std::string path) : path_(std::move(path)) {}
  ~FusionJournal();
  FusionJournal(const FusionJournal&) = delete;
  FusionJournal& operator=(const FusionJournal&) = delete;

  /// Starts an empty journal.
  void clear();
  /// Calls `again` for each tick before `tick`, and writes after them from then on. Throws `Error`
  /// if the journal ends before.
  void resume(Tick tick, const std::function<void(Tick, std::span<const Message>)>& again);
  /// Calls `again` for each tick from `from` to the one before `before`. Throws `Error` if the
  /// journal ends before.
  void replay(Tick from, Tick before,
              const std::function<void(Tick, std::span<const Message>)>& again) const;
  void add(std::span<const Message> inputs);
  /// Writes the end of a tick.
  void end(Tick tick);

  /// Returns the first tick that a journal does not have.
  static Tick ticks_written(const std::string& path);

 private:
  /// Returns the bytes up to the end of the last tick.
  std::uintmax_t read(Tick from, Tick before,
                      const std::function<void(Tick, std::span<const Message>)>& again) const;
  void open(const char* mode);
  [[noreturn]] void fail(const std::string& reason) const;

  std::string path_;
  std::FILE* file_ = nullptr;
};

/// Returns the path of the journal of a run.
std::string fusion_journal_path(const std::string& directory);

}  // namespace dmise
