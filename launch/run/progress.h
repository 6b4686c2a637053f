#pragma once
#include <chrono>
#include <string>

namespace dmise {

/// Progress of a running simulation.
struct ProgressState {
  double simulated_s = 0.0;
  double duration_s = 0.0;
  int frames = 0, frames_total = 0;
  long detections = 0;
  std::string waiting_for;  // nodes that the clock waits for, empty if unknown
};

/// A progress bar on a terminal; otherwise at most one line every 5 s.
class Progress {
 public:
  Progress();
  ~Progress();
  void show(const ProgressState& state, bool last = false);
  /// Whether `show` would print now.
  bool is_due() const;
  /// Shows other work, with the fraction `share` in [0, 1] done.
  void show_share(double share, const std::string& what);
  /// Clears the bar, so that other text can follow.
  void clear_line();

 private:
  bool due(bool last);
  void draw(double share, const std::string& line, bool last);

  std::chrono::steady_clock::time_point start_, shown_;
  bool terminal_;
  double interval_s_;
  bool open_line_ = false;
};

}  // namespace dmise
