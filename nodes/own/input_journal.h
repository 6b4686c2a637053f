#pragma once
#include <cstdint>
#include <cstdio>
#include <fstream>
#include <functional>
#include <span>
#include <string>
#include <vector>

#include "core/sim/message.h"

namespace dmise {

/// Reads a journal tick by tick, also while it is written.
class InputReader {
 public:
  explicit InputReader(const std::string& path);

  /// The tick that is read next; from 0.
  Tick tick() const { return tick_; }
  /// Bytes up to the end of the last tick that was read.
  std::uintmax_t bytes() const { return bytes_; }
  /// Reads the messages of a tick, or leaves them out if `messages` is null. False if the journal
  /// ends before the tick does.
  bool next(std::vector<Message>* messages);

 private:
  std::ifstream file_;
  Tick tick_ = 0;
  std::uintmax_t bytes_ = 0;
};

/// The inputs of a node tick by tick, so that a process or a program that continues its work can
/// repeat the earlier ticks. Each message has a checksum; a tick counts when its end is written.
/// Methods throw `Error` "PATH: reason".
class InputJournal {
 public:
  explicit InputJournal(std::string path) : path_(std::move(path)) {}
  ~InputJournal();
  InputJournal(const InputJournal&) = delete;
  InputJournal& operator=(const InputJournal&) = delete;

  const std::string& path() const { return path_; }
  /// Starts an empty journal.
  void clear();
  /// Calls `again` for each tick before `tick`, and writes after them from then on. Throws `Error`
  /// if the journal ends before.
  void resume(Tick tick, const std::function<void(Tick, std::span<const Message>)>& again);
  /// Writes after its last whole tick from then on. Returns the first tick that it does not have.
  Tick resume();
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
  void continue_after(std::uintmax_t bytes);
  [[noreturn]] void fail(const std::string& reason) const;

  std::string path_;
  std::FILE* file_ = nullptr;
};

/// Returns the path of the journal of a node in the directory of a run.
std::string input_journal_path(const std::string& directory, const std::string& node);

}  // namespace dmise
