#pragma once
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/sim/run_phase.h"
#include "core/sim/tally.h"
#include "core/sim/topic_graph.h"
#include "time-master/pace.h"
#include "time-master/pulse.h"

namespace dmise {

/// What becomes of a run when one of its nodes falls silent.
enum class SilentPolicy {
  fail,  // the run ends with that as its cause
  wait,  // the clock stands until the node is heard again, or another process joins under its name
  drop,  // the run goes on without it
};

struct CoordinatorOptions : PulseLimits {
  std::vector<std::string> expected;  // names; no other may join but observers
  Tick first_tick = 0;                // > 0: goes on with a run that was interrupted
  Tick last_tick = 0;                 // ticks are first_tick..last_tick
  int window_ticks = 1;               // >= 1; 1 is lock-step
  PaceOptions pace;
  Instant stalled_after{0};  // longest time that one for whom all wait neither computes nor is
                             // done, though all that it needs is published; 0: none
  Instant start_within{0};   // longest time until all are ready; 0: none
  SilentPolicy on_silent = SilentPolicy::fail;
  Instant rejoin_within{0};  // under `wait`, longest time until a lost node is back; 0: none
  int max_rejoins = -1;      // under `wait`, processes that may follow the first of a name; -1: any
  std::size_t max_observers = 64;
};

/// The lock-step protocol as a state machine that has never seen a socket: who is in the run, up to
/// which tick all may process, who holds the clock, how a run ends and why. A grant reaches at most
/// `window_ticks` beyond what the slowest node has done. `model/lockstep.pml` is its model.
class Coordinator {
 public:
  struct Request {
    NodeTopics node;
    bool keeps_time = true;  // false: the clock does not wait for it (the broker)
    bool observer = false;   // joins and leaves at any time under a name of its own, holds nobody
    bool agent = false;      // stands for the nodes of a host, under a name of its own
    std::string host;        // the agent that it is behind; empty: it speaks for itself
  };
  struct Member {
    NodeTopics node;
    bool keeps_time = true;
    bool observer = false;
    bool agent = false;
    bool idle = false;  // an agent without nodes once the start has begun: holds nobody
    std::string host;   // as in Request
    bool ready = false;
    bool silent = false;  // under SilentPolicy::wait
    bool left = false;    // said goodbye, or was dropped
    bool dropped = false;
    std::uint64_t incarnation = 1;  // of the name: counts its processes
    Tick done = -1;
    Tick resumes_at = 0;         // the first tick that this process is to say done
    Tick closed_from = 0;        // of a dropped node: its topics are empty from this tick on
    std::deque<TickTally> said;  // of ticks that not all have done
    Pulse pulse;
    Instant silent_since{0};
    std::vector<std::string> waits_for;  // of an agent: those of its nodes that it waits for

    bool active() const { return !left; }
    /// It may come, go and fall silent without anything becoming of the run.
    bool is_guest() const { return observer || idle; }
    /// Nobody waits for it up to and with this tick.
    Tick reaches() const { return node.schedule.next_after(done) - 1; }
  };

  explicit Coordinator(CoordinatorOptions options, Instant now = Instant{0});

  /// The reason if the node is refused; nothing is changed then. A process that follows a lost one
  /// takes its place in the next incarnation and does again what not all have done.
  std::optional<std::string> join(const Request& request, Instant now = Instant{0});
  void ready(const std::string& name, Instant now = Instant{0});
  void done(const std::string& name, Tick tick, Instant now = Instant{0}) {
    done(name, TickTally{tick, {}}, now);
  }
  void done(const std::string& name, TickTally tally, Instant now = Instant{0});
  void heartbeat(const std::string& name, bool computing, std::uint64_t progress, Instant now);
  /// Its connection broke: it has `suspect_after` from now to be heard again.
  void suspect(const std::string& name, Instant now);
  void leave(const std::string& name, bool interrupted, Instant now = Instant{0});
  void fail(const std::string& name, const std::string& reason);

  // What agents say of the nodes behind them; nothing of an earlier incarnation counts. `done` of
  // an agent is said tick by tick, when all its nodes have done the tick.
  void lost_behind(const std::string& name, std::uint64_t incarnation, const std::string& how,
                   Tick done, Instant now = Instant{0});
  void found_behind(const std::string& name, std::uint64_t incarnation);
  void fail_behind(const std::string& name, std::uint64_t incarnation, const std::string& reason);
  /// For those who ask: whom it waits for, and what each has done.
  void report_behind(const std::string& agent, std::vector<std::string> waits_for,
                     const std::map<std::string, Tick>& done);

  /// Ends a run that has not ended, from outside, at once.
  void stop(const std::string& reason);
  /// Finds who has been silent or without progress for too long, and grants what has become due.
  /// Call it at next_check() and next_due(), or sooner.
  void check(Instant now);
  /// The clock's own process did not run between `since` and `now`: nobody could be heard.
  void excuse(Instant since, Instant now);

  /// No tick is granted after `at`, or after the last granted if that is later.
  void pause(Tick at = -1);
  void step(Tick ticks, Instant now = Instant{0});
  void go_on(Instant now = Instant{0});
  /// The run ends when all have done what is granted: nothing is left half done.
  void end_early(const std::string& reason);

  Phase phase() const { return phase_; }
  bool over() const { return phase_ == Phase::ended || phase_ == Phase::failed; }
  /// First cause of a failed run, or why it ended early.
  const std::string& cause() const { return cause_; }
  /// Nodes may process up to this tick; first_tick - 1 before the start.
  Tick granted() const { return granted_; }
  /// All have done this tick and those before.
  Tick settled() const { return settled_; }
  /// Paused, and all have done what was granted.
  bool frozen() const { return pace_.paused() && settled_ >= granted_; }
  const Pace& pace() const { return pace_; }
  /// When `check` has something to grant, if time alone brings it.
  std::optional<Instant> next_due() const;
  /// When `check` has somebody to name, unless more is heard until then. Not before anybody has
  /// joined.
  std::optional<Instant> next_check() const { return next_check_; }
  /// Expected and not yet joined, in the order of the list.
  std::vector<std::string> missing() const;
  /// Whom everybody waits for: those to join, to be ready, the silent, or the furthest behind who
  /// wait for nobody's topics themselves. Nobody when the wall clock or a pause holds the clock.
  std::vector<std::string> holding() const;
  /// True when nobody is left.
  bool deserted() const;
  /// Grows whenever a process of the run has joined after the start, so that all must hear who is
  /// where. Observers are told alone.
  std::uint64_t topology_version() const { return topology_version_; }
  /// First tick whose messages a process of this node publishes: `resumes_at` less what those who
  /// depend on it may need.
  Tick publishes_from(const Member& member) const;
  /// Ticks that a node keeps for whoever asks again.
  Tick keep_ticks(const std::string& name) const;
  /// Of all that was published in ticks that all have done: the same for the same run.
  std::uint64_t digest() const { return digest_; }
  /// Those whom the clock hears itself: nodes, agents, the broker, observers.
  const std::map<std::string, Member>& members() const { return members_; }
  /// The nodes behind agents.
  const std::map<std::string, Member>& behind() const { return behind_; }
  /// Node, agent or observer that has joined.
  const Member& member_of(const std::string& name) const;
  const CoordinatorOptions& options() const { return options_; }
  /// Names that the run has forgotten since the last call, as if they had never joined.
  std::vector<std::string> take_forgotten() { return std::exchange(forgotten_, {}); }

 private:
  Member* active(const std::string& name);
  std::optional<std::string> rejoin(Member& member, const Request& request, Instant now);
  std::optional<std::string> observe(const Request& request, Instant now);
  std::optional<std::string> join_agent(const Request& request, Instant now);
  std::optional<std::string> join_behind(const Request& request, Instant now);
  std::optional<std::string> take_place(Member& member, Instant now);
  bool is_expected(const std::string& name) const;
  std::string not_expected(const std::string& name) const;
  Member fresh(const Request& request, Instant now);
  void add(const Request& request, Instant now) {
    members_[request.node.name] = fresh(request, now);
  }
  void forget(const std::string& name);
  void set_idle_agents();
  Member* behind(const std::string& name, std::uint64_t incarnation);
  std::vector<std::string> nodes_behind(const std::string& agent) const;
  void heard(Member& member, Instant now);
  void check_by(Instant deadline);
  void look_at(Member& member, Instant now);
  void look_for_stalled(Instant now);
  void lost(Member& member, const std::string& how, Instant now);
  void wait_or_fail(Member& member, const std::string& how, Instant now);
  void silence(Member& member, Instant now);
  void drop(Member& member, Instant now);
  void fail_run(const std::string& cause);
  void connect_if_complete(Instant now);
  void start_if_ready(Instant now);
  bool notes(Member& member, TickTally tally);
  void settle(Tick last, Instant now);
  void grant(Instant now);
  Tick slowest_done() const;
  std::string after_tick(const Member& member) const;

  CoordinatorOptions options_;
  Pace pace_;
  std::map<std::string, Member> members_;
  std::map<std::string, Member> behind_;
  std::set<std::string> silent_behind_;
  std::map<std::string, std::uint64_t> incarnations_;  // of each name, so far
  std::map<std::string, Tick> history_;
  std::vector<std::string> forgotten_;
  Phase phase_ = Phase::gathering;
  std::string cause_, first_dropped_;
  Tick granted_;
  Tick settled_;
  Tick end_;  // last tick, or an earlier one
  std::uint64_t topology_version_ = 0;
  std::uint64_t digest_ = 0;
  Instant started_;
  std::optional<Instant> next_check_;
  Instant next_look_{0};  // for the stalled
};

}  // namespace dmise
