#include "time-master/coordinator.h"

#include <algorithm>
#include <limits>
#include <set>

#include "core/base/error.h"

namespace dmise {
namespace {

constexpr Tick no_tick = std::numeric_limits<Tick>::max();

}  // namespace

std::string joined(const std::vector<std::string>& names) {
  std::string text;
  for (const std::string& name : names) text += (text.empty() ? "" : ", ") + name;
  return text;
}

Coordinator::Coordinator(CoordinatorOptions options, Instant now)
    : options_(std::move(options)),
      pace_(options_.pace, options_.first_tick),
      granted_(options_.first_tick - 1),
      settled_(options_.first_tick - 1),
      end_(options_.last_tick),
      started_(now) {
  if (options_.window_ticks < 1) throw ConfigError("window_ticks: must be >= 1");
  if (options_.first_tick < 0) throw ConfigError("first_tick: must be >= 0");
  if (options_.last_tick < options_.first_tick) throw ConfigError("ticks: must be >= 1");
  if (options_.expected.empty()) throw ConfigError("expect: must name a node");
  auto names = options_.expected;
  std::sort(names.begin(), names.end());
  const auto twice = std::adjacent_find(names.begin(), names.end());
  if (twice != names.end()) throw ConfigError("two nodes are named " + *twice);
}

std::optional<std::string> Coordinator::join(const Request& request, Instant now) {
  const std::string& name = request.node.name;
  if (over()) return "the run is over";
  if (request.node.schedule.period < 1 || request.node.schedule.offset < 0 ||
      request.node.look_back < 0)
    return "its period must be >= 1, its offset and look-back >= 0";
  if (request.observer) return observe(request, now);
  if (std::find(options_.expected.begin(), options_.expected.end(), name) ==
      options_.expected.end())
    return "this run has no node named " + name + "; it has " + joined(options_.expected);
  if (const auto earlier = members_.find(name); earlier != members_.end()) {
    const Member& member = earlier->second;
    const bool gone = member.silent || member.suspected;
    if (phase_ != Phase::gathering && gone && member.active() &&
        options_.on_silent == SilentPolicy::wait)
      return rejoin(earlier->second, request, now);
    if (phase_ != Phase::gathering || !gone) return "a node named " + name + " has already joined";
  }
  add(request, now);
  connect_if_complete(now);
  return std::nullopt;
}

Coordinator::Member& Coordinator::add(const Request& request, Instant now) {
  Member& member = members_[request.node.name] = {};
  member.node = request.node;
  member.keeps_time = request.keeps_time && !request.observer;
  member.observer = request.observer;
  member.ready = !member.keeps_time;
  member.incarnation = ++incarnations_[request.node.name];
  member.resumes_at = settled_ + 1;
  member.done = settled_;
  member.progressed = now;
  heard(member, now);
  return member;
}

std::optional<std::string> Coordinator::observe(const Request& request, Instant now) {
  const std::string& name = request.node.name;
  const auto& expected = options_.expected;
  if (std::find(expected.begin(), expected.end(), name) != expected.end())
    return name + " is a node of this run and can't be the name of an observer";
  if (members_.contains(name)) return "an observer named " + name + " has already joined";
  if (!request.node.produces.empty()) return "an observer publishes nothing";
  add(request, now);
  if (phase_ != Phase::gathering) ++topology_version_;
  return std::nullopt;
}

std::optional<std::string> Coordinator::rejoin(Member& member, const Request& request,
                                               Instant now) {
  const std::string& name = request.node.name;
  const NodeTopics& before = member.node;
  if (before.produces != request.node.produces || before.consumes != request.node.consumes ||
      before.look_back != request.node.look_back || !(before.schedule == request.node.schedule) ||
      member.keeps_time != request.keeps_time)
    return name + " joins again with other topics than before";
  if (options_.max_rejoins >= 0 && member.incarnation > std::uint64_t(options_.max_rejoins)) {
    fail_run(name + " has died " + std::to_string(member.incarnation) + " times");
    return "the run is over";
  }
  member.incarnation = ++incarnations_[name];
  // It may have died with messages of ticks that it called done: it does again what anybody may
  // still need. Their tallies stay, to be compared.
  member.resumes_at = slowest_done() + 1;
  member.done = member.resumes_at - 1;
  member.computing = false;
  member.progress = 0;
  member.progressed = now;
  member.ready = !member.keeps_time;
  heard(member, now);
  ++topology_version_;
  start_if_ready(now);
  return std::nullopt;
}

void Coordinator::connect_if_complete(Instant now) {
  if (phase_ != Phase::gathering || !missing().empty()) return;
  std::vector<NodeTopics> nodes;
  for (const std::string& name : options_.expected) nodes.push_back(members_.at(name).node);
  if (const auto fault = topic_fault(nodes)) return fail_run(*fault);
  history_ = history_ticks(nodes);
  phase_ = Phase::connecting;
  ++topology_version_;
  start_if_ready(now);
}

void Coordinator::ready(const std::string& name, Instant now) {
  Member* member = active(name);
  if (!member) return;
  heard(*member, now);
  member->ready = true;
  start_if_ready(now);
}

void Coordinator::start_if_ready(Instant now) {
  if (phase_ != Phase::connecting || !holding().empty()) return;
  phase_ = Phase::running;
  pace_.start(now);
  grant(now);
}

void Coordinator::done(const std::string& name, TickTally tally, Instant now) {
  Member* member = active(name);
  if (!member || over()) return;
  heard(*member, now);
  if (tally.tick <= member->done) return;  // said twice
  const Tick next = member->node.schedule.next_after(member->done);
  if (member->observer) {
    member->done = tally.tick;
    return;
  }
  if (!member->keeps_time || tally.tick != next || tally.tick > granted_)
    return fail_run(name + ": tick " + std::to_string(tally.tick) + " is done, but " +
                    std::to_string(next) + " was next and " + std::to_string(granted_) +
                    " the last granted");
  member->done = tally.tick;
  member->progressed = now;
  if (notes(*member, std::move(tally))) grant(now);
}

/// False when a tick that is done again is not what it was: then the run has failed.
bool Coordinator::notes(Member& member, TickTally tally) {
  tally.incarnation = member.incarnation;
  const auto at = std::lower_bound(member.said.begin(), member.said.end(), tally.tick,
                                   [](const TickTally& t, Tick tick) { return t.tick < tick; });
  if (at == member.said.end() || at->tick != tally.tick) {
    member.said.insert(at, std::move(tally));
    return true;
  }
  if (!std::equal(at->topics.begin(), at->topics.end(), tally.topics.begin(), tally.topics.end(),
                  [](const TopicTally& a, const TopicTally& b) { return a.same_content(b); })) {
    fail_run(member.node.name + ": tick " + std::to_string(tally.tick) +
             ", done again after a restart, is not what it was");
    return false;
  }
  *at = std::move(tally);  // the sequence numbers are those of the new process
  return true;
}

void Coordinator::grant(Instant now) {
  if (phase_ != Phase::running) return;
  const Tick slowest = slowest_done();
  if (slowest == no_tick) return fail_run("no node is left");
  settle(slowest, now);
  if (slowest >= end_) {
    phase_ = Phase::ended;
    return;
  }
  granted_ =
      std::max(granted_, std::min({slowest + options_.window_ticks, end_, pace_.limit(now)}));
}

void Coordinator::settle(Tick slowest, Instant now) {
  for (auto& [name, member] : members_)
    while (!member.said.empty() && member.said.front().tick <= slowest) {
      for (const TopicTally& topic : member.said.front().topics)
        member.digest = fold_digest(fold_digest(member.digest, topic.messages), topic.digest);
      member.said.pop_front();
    }
  for (const Tick last = std::min(slowest, end_); settled_ < last;) pace_.finished(++settled_, now);
}

void Coordinator::pause(Tick at) {
  if (!over()) pace_.pause(std::max(at, granted_));
}

void Coordinator::step(Tick ticks, Instant now) {
  pace_.step(std::max<Tick>(ticks, 0));
  grant(now);
}

void Coordinator::go_on(Instant now) {
  pace_.go_on(now);
  grant(now);
}

void Coordinator::end_early(const std::string& reason) {
  if (over()) return;
  if (phase_ != Phase::running) return fail_run(reason);
  end_ = granted_;
  cause_ = reason;
  if (slowest_done() >= end_) phase_ = Phase::ended;
}

std::optional<Instant> Coordinator::next_due() const {
  if (phase_ != Phase::running) return std::nullopt;
  const Tick allowed = std::min(std::min(slowest_done(), end_) + options_.window_ticks, end_);
  if (granted_ >= allowed) return std::nullopt;
  return pace_.due_after(granted_);
}

Coordinator::Member* Coordinator::active(const std::string& name) {
  const auto found = members_.find(name);
  return found != members_.end() && found->second.active() ? &found->second : nullptr;
}

std::vector<std::string> Coordinator::missing() const {
  std::vector<std::string> names;
  for (const std::string& name : options_.expected)
    if (!members_.contains(name)) names.push_back(name);
  return names;
}

std::vector<std::string> Coordinator::holding() const {
  if (phase_ == Phase::gathering) return missing();
  std::vector<std::string> names;
  if (phase_ == Phase::connecting) {
    for (const std::string& name : options_.expected)
      if (!members_.at(name).ready || members_.at(name).silent) names.push_back(name);
    return names;
  }
  if (over()) return names;
  for (const auto& [name, member] : members_)
    if (member.silent) names.push_back(name);
  const Tick slowest = slowest_done();
  if (!names.empty() || slowest >= granted_) return names;
  std::set<std::string> late_topics;  // of those who are behind
  const auto behind = [&](const Member& member) {
    return member.keeps_time && member.active() && member.reaches() == slowest;
  };
  for (const auto& [name, member] : members_)
    if (behind(member))
      late_topics.insert(member.node.produces.begin(), member.node.produces.end());
  for (const std::string& name : options_.expected) {
    const Member& member = members_.at(name);
    const auto& needs = member.node.consumes;
    const bool waits = std::any_of(needs.begin(), needs.end(), [&](const std::string& topic) {
      return late_topics.contains(topic);
    });
    if (behind(member) && !waits) names.push_back(name);
  }
  return names;
}

Tick Coordinator::slowest_done() const {
  Tick slowest = no_tick;
  for (const auto& [name, member] : members_)
    if (member.keeps_time && member.active()) slowest = std::min(slowest, member.reaches());
  return slowest;
}

Tick Coordinator::publishes_from(const Member& member) const {
  const auto history = history_.find(member.node.name);
  return std::max<Tick>(0, member.resumes_at - (history == history_.end() ? 0 : history->second));
}

Tick Coordinator::keep_ticks(const std::string& name) const {
  const auto history = history_.find(name);
  return options_.window_ticks + 1 + (history == history_.end() ? 0 : history->second);
}

bool Coordinator::deserted() const {
  return std::none_of(members_.begin(), members_.end(),
                      [](const auto& entry) { return entry.second.active(); });
}

std::uint64_t Coordinator::digest() const {
  std::uint64_t digest = 0;
  for (const auto& [name, member] : members_)
    if (member.keeps_time) digest = fold_digest(digest, member.digest);
  return digest;
}

}  // namespace dmise
