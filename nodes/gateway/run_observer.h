#pragma once
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <vector>

#include "nodes/gateway/latest_messages.h"
#include "nodes/gateway/view_history.h"
#include "nodes/gateway/viewer_command.h"
#include "nodes/runtime/process/event.h"

namespace dmise {

struct RunObserverOptions {
  std::string name = "gateway";  // name of its key
  std::string master;            // address of the time-master
  std::string keys;              // directory of keys; empty: none
  bool takes_truth = false;      // from each sensor; with keys its key must allow that
  const Event* stop = nullptr;
  double answer_within_s = 0.0;  // the time-master's first; 0: it is waited for
  /// Called about twice a second with the frame endpoints of sensors; none: the run is over.
  std::function<void(std::uint64_t run_id, std::map<std::string, std::string> endpoints)>
      frames_served_at = [](std::uint64_t, const std::map<std::string, std::string>&) {};
};

/// Observes a run from outside, as any subscriber does: asks the time-master for its state,
/// subscribes at the broker, and requests the roster from the orbit node once. It is not a member
/// of the run, nobody waits for it, and it takes truth only if its options say so.
class RunObserver {
 public:
  RunObserver(RunObserverOptions options, LatestMessages& latest, ViewHistory& history)
      : options_(std::move(options)), latest_(latest), history_(history) {}

  /// Observes until `stop`, on its own thread. `changed`: called there some ten times a second when
  /// there is news. Throws `ConfigError` for keys that cannot be used, `Error` without the first
  /// answer in time.
  void run(const std::function<void()>& changed);

  /// Queues a command for the clock, sent with the operator's key; from any thread. False if too
  /// many commands wait.
  bool command(const ClockCommand& command);

 private:
  class Connections;
  std::vector<ClockCommand> take_commands();

  RunObserverOptions options_;
  LatestMessages& latest_;
  ViewHistory& history_;
  std::mutex mutex_;
  std::vector<ClockCommand> commands_;
  Event has_commands_;
};

}  // namespace dmise
