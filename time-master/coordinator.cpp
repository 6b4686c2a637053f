#include "time-master/coordinator.h"

#include <algorithm>
#include <limits>

#include "core/base/error.h"

namespace dmise {
namespace {

constexpr Tick no_tick = std::numeric_limits<Tick>::max();

}  // namespace

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

void Coordinator::done(const std::string& name, TickTally tally, Instant now) {
  Member* member = active(name);
  if (!member || over()) return;
  heard(*member, now);
  if (tally.tick <= member->done) return;  // repeated
  const Tick next = member->node.schedule.next_after(member->done);
  if (member->is_guest()) {
    if (member->observer) member->done = tally.tick;
    return;
  }
  const bool in_turn = tally.tick == next || member->agent;
  if (!member->keeps_time || !in_turn || tally.tick > granted_)
    return fail_run(name + ": tick " + std::to_string(tally.tick) + " is done, but " +
                    std::to_string(next) + " was next and " + std::to_string(granted_) +
                    " the last granted");
  member->done = tally.tick;
  member->pulse.progressed = now;
  member->pulse.stalled.reset();
  if (record(*member, std::move(tally))) grant(now);
}

/// Compares a repeated tick with the first time; on a difference the run fails and false is
/// returned.
bool Coordinator::record(Member& member, TickTally tally) {
  if (!member.agent)
    for (TopicTally& topic : tally.topics) topic.incarnation = member.incarnation;
  const auto at = std::ranges::lower_bound(member.manifests, tally.tick, {}, &TickTally::tick);
  if (at == member.manifests.end() || at->tick != tally.tick) {
    member.manifests.insert(at, std::move(tally));
    return true;
  }
  // A new agent does not know which topics its predecessor was asked to report.
  const bool same = member.agent
                        ? at->digest == tally.digest
                        : std::ranges::equal(at->topics, tally.topics, &TopicTally::same_content);
  if (!same) {
    fail_run(member.node.name + ": tick " + std::to_string(tally.tick) +
             ", repeated after a restart, differs from the first time");
    return false;
  }
  *at = std::move(tally);  // the sequence numbers are those of the new process
  return true;
}

void Coordinator::grant(Instant now) {
  if (phase_ != Phase::running) return;
  const Tick slowest = slowest_done();
  if (slowest == no_tick)
    return fail_run("no node is left" + (first_dropped_.empty()
                                             ? ""
                                             : "; the first that was lost was " + first_dropped_));
  granted_ =
      std::max(granted_, std::min({slowest + options_.window_ticks, end_, pace_.limit(now)}));
  // Ticks at which no node works pass at once.
  const Tick over_to = std::min(slowest, granted_);
  if (over_to > settled_) settle(over_to, now);
  if (over_to >= end_) phase_ = Phase::ended;
}

void Coordinator::settle(Tick last, Instant now) {
  for (auto& [name, member] : members_)
    while (!member.manifests.empty() && member.manifests.front().tick <= last) {
      const TickTally& tally = member.manifests.front();
      digest_ += member.agent ? tally.digest : content_digest(name, tally);
      member.manifests.pop_front();
    }
  while (settled_ < last) pace_.finished(++settled_, now);
}

void Coordinator::pause(Tick at, Instant now) {
  if (!over()) pace_.pause(std::max(at, granted_), granted_ + 1, now);
}

void Coordinator::step(Tick ticks, Instant now) {
  pace_.step(std::max<Tick>(ticks, 0), granted_ + 1);
  grant(now);
}

void Coordinator::go_on(Instant now) {
  pace_.go_on(granted_ + 1, now);
  grant(now);
}

void Coordinator::change_pace(double factor, Instant now) {
  pace_.change(factor, granted_ + 1, now);
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
    if (!members_.contains(name) && !behind_.contains(name)) names.push_back(name);
  return names;
}

const Coordinator::Member& Coordinator::member_of(const std::string& name) const {
  const auto found = behind_.find(name);
  return found != behind_.end() ? found->second : members_.at(name);
}

std::vector<std::string> Coordinator::holding() const {
  if (phase_ == Phase::gathering) return missing();
  std::vector<std::string> names;
  if (over()) return names;
  if (phase_ == Phase::connecting) {
    for (const std::string& name : options_.expected) {
      const Member& member = member_of(name);
      if (member.dropped) continue;
      const Member& speaks = member.host.empty() ? member : members_.at(member.host);
      if (!speaks.ready || speaks.silent || member.silent) names.push_back(name);
    }
    return names;
  }
  names.assign(silent_behind_.begin(), silent_behind_.end());
  for (const auto& [name, member] : members_)
    if (member.silent) names.push_back(name);
  const Tick slowest = slowest_done();
  if (!names.empty() || slowest >= granted_) return names;
  std::map<std::string, std::string> late_topics;  // topics of slow nodes, with their publishers
  const auto late = [&](const Member& member) {
    return member.keeps_time && member.active() && member.reaches() == slowest;
  };
  for (const auto& [name, member] : members_)
    if (late(member))
      for (const std::string& topic : member.node.produces) late_topics[topic] = name;
  for (const auto& entry : members_) {
    const std::string& name = entry.first;
    const Member& member = entry.second;
    const auto& needs = member.node.consumes;
    const bool waits = std::any_of(needs.begin(), needs.end(), [&](const std::string& topic) {
      const auto owner = late_topics.find(topic);
      return owner != late_topics.end() && owner->second != name && member.node.delay(topic) == 0;
    });
    if (!late(member) || waits) continue;
    if (member.waits_for.empty())
      names.push_back(name);
    else
      names.insert(names.end(), member.waits_for.begin(), member.waits_for.end());
  }
  return names;
}

Tick Coordinator::slowest_done() const {
  Tick slowest = no_tick;
  for (const auto& [name, member] : members_) {
    if (!member.keeps_time || !member.active()) continue;
    slowest = std::min(slowest, member.reaches());
    if (slowest <= settled_) break;  // the slowest
  }
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
  return std::ranges::none_of(members_, [](const auto& entry) { return entry.second.active(); });
}

}  // namespace dmise
