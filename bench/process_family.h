#pragma once
#include <sys/types.h>

#include <map>
#include <string>
#include <vector>

namespace dmise {

/// Resources of one process, from /proc.
struct ProcessUse {
  std::string name;          // its `--name`, or its program
  double pss_mb = 0.0;       // proportional set size [10^6 bytes]
  double peak_pss_mb = 0.0;  // largest observed
  double max_pss_mb = 0.0;   // upper bound: the peak of its resident set minus
                             // currently shared memory
  double cpu_s = 0.0;        // processor time of all threads
};

/// A process and its children, observed from outside. Reading the memory of a hundred takes about
/// 0.1 s.
class ProcessFamily {
 public:
  explicit ProcessFamily(pid_t parent) : parent_(parent) {}

  /// Updates the list of processes and their resources.
  void update();
  /// Sum of PSS at the last update, and its maximum [MB].
  double pss_mb() const { return pss_mb_; }
  double peak_pss_mb() const { return peak_pss_mb_; }
  /// Processor time of all processes, including ended ones [s].
  double cpu_s() const;

  /// All processes observed so far.
  std::vector<ProcessUse> members() const;

 private:
  pid_t parent_;
  std::map<pid_t, ProcessUse> members_;
  double pss_mb_ = 0.0, peak_pss_mb_ = 0.0;
};

}  // namespace dmise
