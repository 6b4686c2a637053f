#include "launch/run/progress.h"

#include <unistd.h>

#include <algorithm>
#include <cstdio>

#include "core/base/formatted.h"
#include "core/base/printable.h"

namespace dmise {

using Seconds = std::chrono::duration<double>;

Progress::Progress()
    : start_(std::chrono::steady_clock::now()),
      shown_(start_ - std::chrono::hours(1)),
      terminal_(isatty(STDERR_FILENO)),
      interval_s_(terminal_ ? 0.1 : 5.0) {}

Progress::~Progress() { clear_line(); }

void Progress::clear_line() {
  if (open_line_) std::fputs("\n", stderr);
  open_line_ = false;
}

bool Progress::is_due() const {
  return Seconds(std::chrono::steady_clock::now() - shown_).count() >= interval_s_;
}

bool Progress::due(bool last) {
  if (!last && !is_due()) return false;
  shown_ = std::chrono::steady_clock::now();
  return true;
}

void Progress::show_share(double share, const std::string& what) {
  // Without a terminal, work that ends before the first line is silent.
  if (!terminal_ && Seconds(std::chrono::steady_clock::now() - start_).count() < interval_s_)
    return;
  if (!due(false)) return;
  draw(share,
       formatted("%s: %.0f %%, %.0f s elapsed", what.c_str(), 100.0 * share,
                 Seconds(shown_ - start_).count()),
       false);
}

void Progress::show(const ProgressState& s, bool last) {
  if (!due(last)) return;
  std::string line = formatted(
      "simulated %.0f of %.0f s, frames %d of %d, detections %ld, %.0f s elapsed", s.simulated_s,
      s.duration_s, s.frames, s.frames_total, s.detections, Seconds(shown_ - start_).count());
  if (!s.waiting_for.empty()) line += ", waiting for " + printable(s.waiting_for, 400);
  draw(s.duration_s > 0 ? s.simulated_s / s.duration_s : 0.0, line, last);
}

void Progress::draw(double share, const std::string& line, bool last) {
  if (terminal_) {
    constexpr int width = 20;
    const int full = std::clamp(static_cast<int>(share * width), 0, width);
    std::fprintf(stderr, "\r\033[K[%.*s%.*s] %s", full, "####################", width - full,
                 "....................", line.c_str());
    open_line_ = true;
    if (last) clear_line();
  } else {
    std::fprintf(stderr, "%s\n", line.c_str());
  }
  std::fflush(stderr);
}

}  // namespace dmise
