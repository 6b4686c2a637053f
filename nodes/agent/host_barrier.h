#pragma once
#include <deque>
#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "core/sim/schedule.h"
#include "core/sim/tally.h"
#include "time-master/pulse.h"

namespace dmise {

/// What the agent of a host knows of its nodes, as a state machine that has never seen a socket:
/// who is there and lives, and which tick all of them have done. It decides nothing: what a lost
/// node means, who may join and what is granted are the Coordinator's. `model/lockstep_host.pml` is
/// its model.
class HostBarrier {
 public:
  struct Node {
    Schedule schedule;
    std::uint64_t incarnation = 0;
    bool ready = false;
    bool silent = false;
    bool left = false;
    Tick done = -1;
    std::deque<TickTally> said;  // of ticks that may have to be done again
    Pulse pulse;

    /// Nobody waits for it up to and with this tick.
    Tick reaches() const { return schedule.next_after(done) - 1; }
  };
  /// To be told to the master.
  struct News {
    enum class What { lost, found, failed };
    What what;
    std::string name;
    std::uint64_t incarnation = 0;
    std::string reason;
    Tick done = -1;
  };

  explicit HostBarrier(PulseLimits limits) : limits_(limits) {}

  /// The nodes of this host: those who are not there yet are waited for. An agent that follows a
  /// lost one knows nobody, and what some of them have done is not what the host has.
  void expects(std::set<std::string> names) { expected_ = std::move(names); }
  /// A process asks to join, and the master has not answered yet: nothing counts as done meanwhile.
  void asks(const std::string& name) { asking_.insert(name); }
  void refused(const std::string& name) { asking_.erase(name); }
  /// The master has accepted it; it says done from `resumes_at` on. What a process of its name has
  /// said before is done again.
  void join(const std::string& name, Schedule schedule, std::uint64_t incarnation, Tick resumes_at,
            Instant now);
  void ready(const std::string& name, Instant now);
  void done(const std::string& name, TickTally tally, Instant now);
  void heartbeat(const std::string& name, bool computing, std::uint64_t progress, Instant now);
  void suspect(const std::string& name, Instant now);
  void leave(const std::string& name, bool interrupted);
  void fail(const std::string& name, const std::string& reason);
  /// The agent did itself not run between `since` and `now`: it could hear nobody.
  void excuse(Instant since, Instant now);
  /// It has been lost before the start: as if it had never joined.
  void forget(const std::string& name) { nodes_.erase(name); }
  /// Finds who has been silent or without progress for too long.
  void check(Instant now);
  /// Nobody is missed any more.
  void run_is_over() { over_ = true; }
  /// No tick up to and with this one will be done again.
  void settled(Tick tick);

  /// The next tick that all nodes have done, once: what they published at it, in the order of their
  /// names, and its digest. Never after `granted`.
  std::optional<TickTally> take_done(Tick granted);
  std::vector<News> take_news() { return std::exchange(news_, {}); }
  bool all_ready() const;
  /// Those whom the others wait for: not there, lost, or furthest behind.
  std::vector<std::string> holding() const;
  /// Whether this process may still take a name.
  bool knows_living(const std::string& name) const;
  bool deserted() const;
  const std::map<std::string, Node>& nodes() const { return nodes_; }
  const PulseLimits& limits() const { return limits_; }

 private:
  Node* active(const std::string& name);
  void hear(const std::string& name, Node& node, Instant now);
  void tell(News::What what, const std::string& name, const Node& node, const std::string& reason);
  bool notes(const std::string& name, Node& node, TickTally tally);
  Tick slowest() const;
  std::vector<std::string> missing() const;

  PulseLimits limits_;
  std::map<std::string, Node> nodes_;
  std::set<std::string> expected_;
  std::set<std::string> asking_;
  std::vector<News> news_;
  Tick taken_ = -1;
  bool over_ = false;
};

}  // namespace dmise
