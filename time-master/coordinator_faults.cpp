// Nodes that die, hang, fall silent or leave, and the consequences for the run.
#include <algorithm>

#include "core/base/printable.h"
#include "time-master/coordinator.h"

namespace dmise {
namespace {

constexpr const char* indispensable = "broker";

}  // namespace

std::string Coordinator::after_tick(const Member& member) const {
  return " (last tick done: " + std::to_string(member.done) + " of " +
         std::to_string(options_.last_tick) + ")";
}

void Coordinator::check_by(Instant deadline) {
  next_check_ = std::min(next_check_.value_or(deadline), deadline);
}

void Coordinator::heartbeat(const std::string& name, bool computing, std::uint64_t progress,
                            Instant now) {
  Member* member = active(name);
  if (!member) return;
  heard(*member, now);
  member->pulse.beat(computing, progress, now);
  check_by(member->pulse.deadline(options_, !over()));
}

void Coordinator::heard(Member& member, Instant now) {
  member.pulse.heard_at(now);
  member.silent = false;
  check_by(member.pulse.deadline(options_, !over()));
}

void Coordinator::suspect(const std::string& name, Instant now) {
  Member* member = active(name);
  if (!member) return;
  member->pulse.suspect(now);
  check_by(member->pulse.deadline(options_, !over()));
}

void Coordinator::excuse(Instant since, Instant now) {
  for (auto& [name, member] : members_) member.pulse.excuse(since, now);
}

void Coordinator::leave(const std::string& name, bool interrupted, Instant now,
                        const std::string& cause) {
  Member* member = active(name);
  if (!member) return;
  if (over()) {
    member->left = true;
    return;
  }
  if (phase_ == Phase::gathering || member->is_guest()) return forget(name);
  lost(*member,
       interrupted     ? "was interrupted"
       : cause.empty() ? "left before the end"
                       : "gave up: " + cause,
       now);
}

void Coordinator::fail(const std::string& name, const std::string& reason) {
  Member* member = active(name);
  if (!member) return;
  if (member->is_guest()) return forget(name);
  member->left = true;
  if (options_.on_silent == SilentPolicy::drop && member->keeps_time && phase_ == Phase::running)
    drop(*member, member->pulse.heard);
  else
    fail_run(reason.starts_with(name + ": ") ? reason : name + ": " + reason);
}

void Coordinator::check(Instant now) {
  next_check_.reset();
  if (!over() && phase_ != Phase::running && options_.start_within.count() > 0) {
    if (now - started_ >= options_.start_within && !begin_without_missing(now))
      return fail_run("not started within " + in_seconds(options_.start_within) + ": waiting for " +
                      joined(holding()));
    check_by(started_ + options_.start_within);
  }
  for (const std::string& name : silent_behind_) look_at(behind_.at(name), now);
  std::vector<std::string> names;  // lost() may remove a member
  for (const auto& [name, member] : members_) names.push_back(name);
  for (const std::string& name : names)
    if (Member* member = active(name)) look_at(*member, now);
  find_stalled(now);
  grant(now);
}

void Coordinator::look_at(Member& member, Instant now) {
  if (!member.silent) {
    const std::string trouble = member.pulse.trouble(options_, !over(), now);
    return trouble.empty() ? check_by(member.pulse.deadline(options_, !over()))
                           : lost(member, trouble, now);
  }
  if (options_.rejoin_within.count() == 0 || over()) return;
  const Instant back_by = member.silent_since + options_.rejoin_within;
  if (now < back_by) return check_by(back_by);
  fail_run(member.node.name + " has not come back within " + in_seconds(options_.rejoin_within) +
           after_tick(member));
}

/// A node that is alive but does not begin a tick: its inputs do not arrive, or it is faulty.
/// Heartbeats do not reveal it.
void Coordinator::find_stalled(Instant now) {
  if (options_.stalled_after.count() == 0 || phase_ != Phase::running || now < next_look_) return;
  next_look_ = now + options_.stalled_after / 8;
  const std::vector<std::string> names = holding();
  for (auto& [name, member] : members_) {
    auto& since = member.pulse.stalled;
    const std::string& who = member.waits_for.empty() ? name : member.waits_for.front();
    const bool idle = !member.silent && !member.pulse.computing &&
                      std::find(names.begin(), names.end(), who) != names.end();
    if (!idle) since.reset();
    if (!idle || now - since.emplace(since.value_or(now)) < options_.stalled_after) continue;
    if (options_.on_silent == SilentPolicy::drop) return drop(member, now);
    const Member& stalled = member_of(who);
    return fail_run(who + " has not begun tick " +
                    std::to_string(stalled.node.schedule.next_after(stalled.done)) + " for " +
                    in_seconds(now - *since) + ", although all its inputs are published" +
                    after_tick(stalled));
  }
}

void Coordinator::lost(Member& member, const std::string& how, Instant now) {
  if (over()) {
    member.left = true;
    return;
  }
  if (phase_ == Phase::gathering || member.is_guest()) return forget(member.node.name);
  if (options_.on_silent == SilentPolicy::drop && member.keeps_time) return drop(member, now);
  wait_or_fail(member, how, now);
}

void Coordinator::wait_or_fail(Member& member, const std::string& how, Instant now) {
  if (options_.on_silent != SilentPolicy::wait) {
    member.left = true;
    const std::string with_it =
        member.agent ? ", and with it " + joined(nodes_behind(member.node.name)) : "";
    return fail_run(member.node.name + " " + how + after_tick(member) + with_it);
  }
  if (options_.max_rejoins > 0 && member.incarnation > std::uint64_t(options_.max_rejoins))
    return fail_run(member.node.name + " " + how + ", after " +
                    std::to_string(options_.max_rejoins) + " restarts" + after_tick(member));
  silence(member, now);
}

void Coordinator::silence(Member& member, Instant now) {
  member.silent = true;
  member.silent_since = now;
  if (!member.host.empty()) silent_behind_.insert(member.node.name);
}

void Coordinator::drop(Member& member, Instant now) {
  // It may have died with messages of ticks that it reported as done; consumers that are behind do
  // not get them.
  if (first_dropped_.empty()) first_dropped_ = member.node.name;
  member.left = true;
  member.dropped = true;
  member.closed_from = std::min(member.done, slowest_done()) + 1;
  while (!member.manifests.empty() && member.manifests.back().tick >= member.closed_from)
    member.manifests.pop_back();
  start_if_ready(now);
  grant(now);
}

/// Under `drop`, nodes that have not joined in time are lost like others. What they publish is not
/// known: topics that somebody consumes and nobody else produces are theirs.
bool Coordinator::begin_without_missing(Instant now) {
  const std::vector<std::string> names = missing();
  if (options_.on_silent != SilentPolicy::drop || phase_ != Phase::gathering ||
      names.size() == options_.expected.size() ||
      std::ranges::find(names, indispensable) != names.end())
    return false;
  std::set<std::string> topics;
  for (const auto& [name, member] : members_)
    if (!member.observer) topics.insert(member.node.consumes.begin(), member.node.consumes.end());
  for (const auto& [name, member] : members_)
    for (const std::string& topic : member.node.produces) topics.erase(topic);
  for (const std::string& name : names) {
    Member member = fresh({.node = {name, {}, {}}}, now);
    member.left = member.dropped = member.ready = true;
    member.closed_from = options_.first_tick;
    member.node.produces.assign(topics.begin(), topics.end());
    topics.clear();
    members_[name] = std::move(member);
  }
  first_dropped_ = names.front();
  started_ = now;  // those who are left have the full time again
  connect_if_complete(now);
  return true;
}

void Coordinator::fail_run(const std::string& cause) {
  if (over()) return;
  phase_ = Phase::failed;
  cause_ = cause;
}

}  // namespace dmise
