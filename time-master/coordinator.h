#pragma once
#include <chrono>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "core/base/sim_time.h"
#include "time-master/topic_graph.h"

namespace dmise {

/// What becomes of a run when one of its nodes falls silent.
enum class SilentPolicy {
  fail,  // the run ends with that as its cause
  wait,  // the clock stands until the node is heard again
  drop,  // the run goes on without it
};

enum class Phase {
  gathering,   // expected nodes join
  connecting,  // all have joined, each makes sure that it hears what it needs
  running,
  ended,   // every tick is done
  failed,  // see cause()
};

/// Wall-clock time since any fixed instant; handed in, never read here.
using Instant = std::chrono::nanoseconds;

struct CoordinatorOptions {
  std::vector<std::string> expected;  // names; no other may join
  Tick last_tick = 0;                 // ticks are 0..last_tick
  int window_ticks = 1;               // >= 1; 1 is lock-step
  Instant silent_after = std::chrono::seconds(5);
  Instant suspect_after = std::chrono::milliseconds(750);  // after its connection broke
  Instant progress_after{0};                               // longest step without progress; 0: none
  Instant start_within{0};  // longest time until all are ready; 0: none
  SilentPolicy on_silent = SilentPolicy::fail;
};

/// The lock-step protocol as a state machine that has never seen a socket: who is in the run, up to
/// which tick all may process, who holds the clock, how a run ends and why. A grant reaches at most
/// `window_ticks` beyond what the slowest node has done.
class Coordinator {
 public:
  struct Request {
    NodeTopics node;
    bool keeps_time = true;  // false: the clock does not wait for it (the broker)
  };
  struct Member {
    NodeTopics node;
    bool keeps_time = true;
    bool ready = false;
    bool silent = false;  // under SilentPolicy::wait
    bool left = false;    // said goodbye, or was dropped
    bool dropped = false;
    bool computing = false;
    Tick done = -1;
    Tick closed_from = 0;  // of a dropped node: its topics are empty from this tick on
    std::uint64_t progress = 0;
    Instant heard{0};
    Instant progressed{0};
    std::optional<Instant> suspected;

    bool active() const { return !left; }
  };

  explicit Coordinator(CoordinatorOptions options, Instant now = Instant{0});

  /// The reason if the node is refused; nothing is changed then.
  std::optional<std::string> join(const Request& request, Instant now = Instant{0});
  void ready(const std::string& name, Instant now = Instant{0});
  void done(const std::string& name, Tick tick, Instant now = Instant{0});
  void heartbeat(const std::string& name, bool computing, std::uint64_t progress, Instant now);
  /// Its connection broke: it has `suspect_after` from now to be heard again.
  void suspect(const std::string& name, Instant now);
  void leave(const std::string& name, bool interrupted);
  void fail(const std::string& name, const std::string& reason);
  /// Ends a run that has not ended, from outside.
  void stop(const std::string& reason);
  /// Finds who has been silent or without progress for too long. Call it often.
  void check(Instant now);

  Phase phase() const { return phase_; }
  bool over() const { return phase_ == Phase::ended || phase_ == Phase::failed; }
  /// First cause of a failed run.
  const std::string& cause() const { return cause_; }
  /// Nodes may process up to this tick; -1 before the start.
  Tick granted() const { return granted_; }
  /// Expected and not yet joined, in the order of the list.
  std::vector<std::string> missing() const;
  /// Whom everybody waits for: those to join, to be ready, the silent, or the furthest behind who
  /// wait for nobody's topics themselves.
  std::vector<std::string> holding() const;
  /// True when nobody is left.
  bool deserted() const;
  const std::map<std::string, Member>& members() const { return members_; }
  const CoordinatorOptions& options() const { return options_; }

 private:
  Member* active(const std::string& name);
  void heard(Member& member, Instant now);
  void lost(Member& member, const std::string& how);
  void drop(Member& member);
  void fail_run(const std::string& cause);
  void connect_if_complete();
  void start_if_ready();
  void grant();
  Tick slowest_done() const;

  CoordinatorOptions options_;
  std::map<std::string, Member> members_;
  Phase phase_ = Phase::gathering;
  std::string cause_;
  Tick granted_ = -1;
  Instant started_;
};

/// "a, b, c"
std::string joined(const std::vector<std::string>& names);

}  // namespace dmise
