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

/// State of a host's nodes as a state machine without sockets: which are present and alive, and
/// which tick all of them have done. The Coordinator decides what a lost node means, who may join
/// and what is granted. `time-master/model/lockstep_host.pml` is its model.
class HostBarrier {
 public:
  struct Node {
    Schedule schedule;
    std::uint64_t incarnation = 0;
    bool ready = false;
    bool silent = false;
    bool left = false;
    Tick done = -1;
    std::deque<TickTally> manifests;  // ticks that may be repeated
    Pulse pulse;

    /// Last tick up to which nobody waits for it.
    Tick reaches() const { return schedule.next_after(done) - 1; }
  };
  /// A report to the master.
  struct News {
    enum class What { lost = 1, found, failed };  // as NodeNews.What in proto/dmise/v1/node.proto
    What what;
    std::string name;
    std::uint64_t incarnation = 0;
    std::string reason;
    Tick done = -1;
  };

  explicit HostBarrier(PulseLimits limits) : limits_(limits) {}

  /// The nodes of this host, including those that have not joined yet. An agent that replaces a
  /// lost one starts without nodes, and ticks that some of them have done do not count for the
  /// host.
  void expects(std::set<std::string> names) { expected_ = std::move(names); }
  /// A process requests to join, and the master has not answered yet: nothing counts as done
  /// meanwhile.
  void begin_join(const std::string& name) { joining_.insert(name); }
  void refused(const std::string& name) { joining_.erase(name); }
  /// The master has accepted it; its first tick is `resumes_at`. Later ticks of an earlier process
  /// of its name are repeated.
  void join(const std::string& name, Schedule schedule, std::uint64_t incarnation, Tick resumes_at,
            Instant now);
  void ready(const std::string& name, Instant now);
  void done(const std::string& name, TickTally tally, Instant now);
  void heartbeat(const std::string& name, bool computing, std::uint64_t progress, Instant now);
  void suspect(const std::string& name, Instant now);
  void leave(const std::string& name, bool interrupted);
  void fail(const std::string& name, const std::string& reason);
  /// Another process of its name asks to join: the earlier one, whose connection broke, is lost.
  void give_up(const std::string& name);
  /// Reports again which nodes are lost and which are not.
  void repeat_news();
  /// The agent was suspended between `since` and `now` and could not receive anything.
  void excuse(Instant since, Instant now);
  /// Removes a node that was lost before the start, as if it had never joined.
  void forget(const std::string& name) { nodes_.erase(name); }
  /// Finds nodes that have been silent or without progress for too long.
  void check(Instant now);
  /// Stops all checks.
  void run_is_over() { over_ = true; }
  /// No tick up to and including this one will be repeated.
  void settled(Tick tick);

  /// Returns, once, the next tick that all nodes have done: what they published at it, in the order
  /// of their names, and its digest. Never after `granted`.
  std::optional<TickTally> take_done(Tick granted);
  std::vector<News> take_news() { return std::exchange(news_, {}); }
  bool all_ready() const;
  /// The nodes that the others wait for: not joined, lost, or furthest behind.
  std::vector<std::string> holding() const;
  /// Whether a live process has this name.
  bool has_live_process(const std::string& name) const;
  bool deserted() const;
  const std::map<std::string, Node>& nodes() const { return nodes_; }
  const PulseLimits& limits() const { return limits_; }

 private:
  Node* active(const std::string& name);
  void hear(const std::string& name, Node& node, Instant now);
  void report(News::What what, const std::string& name, const Node& node,
              const std::string& reason);
  bool record(const std::string& name, Node& node, TickTally tally);
  Tick slowest() const;
  std::vector<std::string> missing() const;

  PulseLimits limits_;
  std::map<std::string, Node> nodes_;
  std::set<std::string> expected_;
  std::set<std::string> joining_;
  std::vector<News> news_;
  Tick taken_ = -1;
  bool over_ = false;
};

}  // namespace dmise
