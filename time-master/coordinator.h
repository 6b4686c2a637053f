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

/// What happens to a run when one of its nodes falls silent.
enum class SilentPolicy {
  fail,  // the run fails
  wait,  // the clock waits until the node returns, or another process of its name joins
  drop,  // the run continues without it
};

struct CoordinatorOptions : PulseLimits {
  std::vector<std::string> expected;  // node names; only observers may join besides
  Tick first_tick = 0;                // > 0: continues an interrupted run
  Tick last_tick = 0;                 // ticks are first_tick..last_tick
  int window_ticks = 1;               // >= 1; 1 is lock-step
  PaceOptions pace;
  Instant stalled_after{0};  // longest time that a node waited for is neither computing nor
                             // done although its inputs are published; 0: unlimited
  Instant start_within{0};   // longest time until all are ready; 0: unlimited
  SilentPolicy on_silent = SilentPolicy::fail;
  Instant rejoin_within{0};  // under `wait`, longest absence of a node; 0: unlimited
  int max_rejoins = -1;      // under `wait`, restarts per node; -1: any
  std::size_t max_observers = 64;
};

/// The lock-step protocol as a state machine without sockets: members of the run, the last tick
/// that all may process, nodes that the clock waits for, how a run ends and why. A grant reaches at
/// most `window_ticks` beyond the last tick of the slowest node. `model/lockstep.pml` is its model.
class Coordinator {
 public:
  struct Request {
    NodeTopics node;
    bool keeps_time = true;  // false: the clock does not wait for it (the broker)
    bool observer = false;   // joins and leaves at any time; the clock does not wait for it
    bool agent = false;      // represents the nodes of a host
    std::string host;        // its agent; empty: none
  };
  struct Member : Request {
    bool idle = false;  // an agent without nodes after the start: not waited for
    bool ready = false;
    bool silent = false;  // under SilentPolicy::wait
    bool left = false;    // has left, or was dropped
    bool dropped = false;
    std::uint64_t incarnation = 1;  // number of processes of the name
    Tick done = -1;
    Tick resumes_at = 0;              // first tick of this process
    Tick closed_from = 0;             // if dropped: first tick without its topics
    std::deque<TickTally> manifests;  // ticks that not all have done
    Pulse pulse;
    Instant silent_since{0};
    std::vector<std::string> waits_for;  // nodes of an agent that hold up the run

    bool active() const { return !left; }
    /// Whether it may join, leave and fall silent without consequences for the run.
    bool is_guest() const { return observer || idle; }
    /// Last tick up to which nobody waits for it.
    Tick reaches() const { return node.schedule.next_after(done) - 1; }
  };

  explicit Coordinator(CoordinatorOptions options, Instant now = Instant{0});

  /// Returns the reason if the node is refused; nothing is changed then. A process that replaces a
  /// lost one joins in the next incarnation and repeats what not all have done.
  std::optional<std::string> join(const Request& request, Instant now = Instant{0});
  void ready(const std::string& name, Instant now = Instant{0});
  void done(const std::string& name, Tick tick, Instant now = Instant{0}) {
    done(name, TickTally{tick, {}}, now);
  }
  void done(const std::string& name, TickTally tally, Instant now = Instant{0});
  void heartbeat(const std::string& name, bool computing, std::uint64_t progress, Instant now);
  /// Its connection broke: it must be heard within `suspect_after`.
  void suspect(const std::string& name, Instant now);
  void leave(const std::string& name, bool interrupted, Instant now = Instant{0},
             const std::string& cause = "");
  void fail(const std::string& name, const std::string& reason);

  // Reports of agents about the nodes behind them; reports of an earlier incarnation are ignored.
  // `done` of an agent comes tick by tick, when all its nodes have done the tick.
  void lost_behind(const std::string& name, std::uint64_t incarnation, const std::string& how,
                   Tick done, Instant now = Instant{0});
  void found_behind(const std::string& name, std::uint64_t incarnation);
  void fail_behind(const std::string& name, std::uint64_t incarnation, const std::string& reason);
  /// For status: nodes waited for, and the last tick of each.
  void report_behind(const std::string& agent, std::vector<std::string> waits_for,
                     const std::map<std::string, Tick>& done);

  /// Ends the run at once, failed. The first cause remains.
  void fail_run(const std::string& cause);
  /// Finds nodes that have been silent or without progress for too long, and grants ticks that are
  /// due. Call at next_check() and next_due(), or earlier.
  void check(Instant now);
  /// The clock's own process was suspended between `since` and `now`: it could not receive
  /// anything.
  void excuse(Instant since, Instant now);

  /// Grants no tick after `at`, or after the last granted one if that is later; those until then
  /// at the pace.
  void pause(Tick at = -1, Instant now = Instant{0});
  void step(Tick ticks, Instant now = Instant{0});
  void go_on(Instant now = Instant{0});
  /// Simulated seconds per second from now on, 0 to max_pace_factor; 0: as fast as possible.
  void change_pace(double factor, Instant now = Instant{0});
  /// Ends the run when all have done the granted ticks.
  void end_early(const std::string& reason);

  Phase phase() const { return phase_; }
  bool over() const { return phase_ == Phase::ended || phase_ == Phase::failed; }
  /// First cause of a failed run, or why it ended early.
  const std::string& cause() const { return cause_; }
  /// Last tick that nodes may process; first_tick - 1 before the start.
  Tick granted() const { return granted_; }
  /// Last tick that all have done.
  Tick settled() const { return settled_; }
  const Pace& pace() const { return pace_; }
  /// Whether a pause has begun: no tick is granted until it ends.
  bool paused() const { return pace_.paused(granted_ + 1); }
  /// When `check` has something to grant, if only time is needed.
  std::optional<Instant> next_due() const;
  /// When `check` will find a lost node unless more is heard until then. Empty before anybody has
  /// joined.
  std::optional<Instant> next_check() const { return next_check_; }
  /// Expected nodes that have not joined, in the order of the list.
  std::vector<std::string> missing() const;
  /// Nodes that the clock waits for: to join, to be ready, the silent, or the furthest behind that
  /// wait for no other node. Empty if real time or a pause stops the clock.
  std::vector<std::string> holding() const;
  /// Whether all members have left.
  bool deserted() const;
  /// Increases whenever a process of the run has joined after the start, so that all need the new
  /// topology. Observers are informed separately.
  std::uint64_t topology_version() const { return topology_version_; }
  /// First tick whose messages a process of this node publishes: `resumes_at` minus what its
  /// consumers may need.
  Tick publishes_from(const Member& member) const;
  /// Ticks that a node keeps for requests.
  Tick keep_ticks(const std::string& name) const;
  /// Digest of everything published in ticks that all have done: the same for the same run.
  std::uint64_t digest() const { return digest_; }
  /// Members that the clock receives directly: nodes, agents, the broker, observers.
  const std::map<std::string, Member>& members() const { return members_; }
  /// The nodes behind agents.
  const std::map<std::string, Member>& behind() const { return behind_; }
  /// Node, agent or observer that has joined.
  const Member& member_of(const std::string& name) const;
  const CoordinatorOptions& options() const { return options_; }
  /// Names removed since the last call, as if they had never joined.
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
  void find_stalled(Instant now);
  void lost(Member& member, const std::string& how, Instant now);
  void wait_or_fail(Member& member, const std::string& how, Instant now);
  void silence(Member& member, Instant now);
  void drop(Member& member, Instant now);
  bool begin_without_missing(Instant now);
  void connect_if_complete(Instant now);
  void start_if_ready(Instant now);
  bool record(Member& member, TickTally tally);
  void settle(Tick last, Instant now);
  void grant(Instant now);
  Tick slowest_done() const;
  std::string after_tick(const Member& member) const;

  CoordinatorOptions options_;
  Pace pace_;
  std::map<std::string, Member> members_;
  std::map<std::string, Member> behind_;
  std::set<std::string> silent_behind_;
  std::map<std::string, std::uint64_t> incarnations_;  // latest incarnation of each name
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
  Instant next_look_{0};  // when `find_stalled` looks again
};

}  // namespace dmise
