#pragma once
#include <sys/types.h>

#include <map>
#include <string>
#include <vector>

namespace dmise {

/// What one process takes, as /proc says.
struct ProcessUse {
  std::string name;          // its `--name`, or its program
  double pss_mb = 0.0;       // now; memory shared with others divided among them [10^6 bytes]
  double peak_pss_mb = 0.0;  // the most that was seen
  double most_pss_mb = 0.0;  // bound of what was not seen: the peak of its resident set, less what
                             // it shares now
  double cpu_s = 0.0;        // of all its threads so far
};

/// A process and its children, looked at from outside. A look at the memory of a hundred costs
/// about 0.1 s.
class ProcessFamily {
 public:
  explicit ProcessFamily(pid_t parent) : parent_(parent) {}

  /// Takes in who is there, what each holds and has spent.
  void look();
  /// Sum of PSS at the last look, and at the look when it was largest [MB].
  double pss_mb() const { return pss_mb_; }
  double peak_pss_mb() const { return peak_pss_mb_; }
  /// Processor time of all, those that ended included [s].
  double cpu_s() const;

  /// All that were ever there.
  std::vector<ProcessUse> members() const;

 private:
  pid_t parent_;
  std::map<pid_t, ProcessUse> members_;
  double pss_mb_ = 0.0, peak_pss_mb_ = 0.0;
};

}  // namespace dmise
