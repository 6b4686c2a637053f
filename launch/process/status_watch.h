#pragma once
#include <map>
#include <string>

#include "nodes/runtime/observability/status.h"
#include "nodes/runtime/observability/tick_rate.h"

namespace dmise {

/// Follows the health of a run's nodes through the answers of its time-master, and shows it as a
/// table for a terminal.
class StatusWatch {
 public:
  struct Layout {
    int columns = 80, rows = 24;  // size of the terminal; nodes beyond it are only counted
    bool colours = false;
  };

  /// `now_s`: time of the answer, seconds of any clock.
  void take(const RunStatus& status, double now_s);
  /// The time-master did not answer at `now_s`, and why.
  void miss(const std::string& reason, double now_s);

  const RunStatus& status() const { return status_; }
  /// Seconds without an answer; 0 if the last question was answered.
  double silent_s() const { return silent_s_; }

  /// Lines with "\n", of at most `columns` characters. Text of other processes is `printable`.
  std::string table(const Layout& layout) const;

 private:
  struct History {
    TickRate rate;
    bool alive = true;
    std::uint64_t incarnation = 1;
    int gaps = 0;            // how often it was lost or replaced
    std::string last_error;  // the last of these, and when
  };
  RunStatus status_;
  std::map<std::string, History> nodes_;
  double answered_s_ = 0.0, silent_s_ = 0.0;
  std::string silence_;
};

/// Whether to use colours: on a terminal that has them, unless NO_COLOR is set (no-color.org).
bool wants_colours(bool terminal, const char* no_color, const char* term);

}  // namespace dmise
