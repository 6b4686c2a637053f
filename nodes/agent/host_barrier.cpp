#include "nodes/agent/host_barrier.h"

#include <algorithm>
#include <limits>

namespace dmise {
namespace {

constexpr Tick no_tick = std::numeric_limits<Tick>::max();

}  // namespace

void HostBarrier::join(const std::string& name, Schedule schedule, std::uint64_t incarnation,
                       Tick resumes_at, Instant now) {
  joining_.erase(name);
  Node& node = nodes_[name];
  node.schedule = schedule;
  node.incarnation = incarnation;
  node.ready = node.silent = node.left = false;
  node.done = resumes_at - 1;
  node.pulse = Pulse::begin(now);
  taken_ = nodes_.size() == 1 ? node.done : std::min(taken_, node.done);
}

HostBarrier::Node* HostBarrier::active(const std::string& name) {
  const auto found = nodes_.find(name);
  return found != nodes_.end() && !found->second.left ? &found->second : nullptr;
}

bool HostBarrier::has_live_process(const std::string& name) const {
  const auto found = nodes_.find(name);
  if (found == nodes_.end()) return joining_.contains(name);
  return !found->second.silent && !found->second.left && !found->second.pulse.suspected;
}

void HostBarrier::report(News::What what, const std::string& name, const Node& node,
                         const std::string& reason) {
  if (!over_) news_.push_back({what, name, node.incarnation, reason, node.done});
}

void HostBarrier::hear(const std::string& name, Node& node, Instant now) {
  node.pulse.heard_at(now);
  if (std::exchange(node.silent, false)) report(News::What::found, name, node, "");
}

void HostBarrier::ready(const std::string& name, Instant now) {
  Node* node = active(name);
  if (!node) return;
  hear(name, *node, now);
  node->ready = true;
}

void HostBarrier::heartbeat(const std::string& name, bool computing, std::uint64_t progress,
                            Instant now) {
  Node* node = active(name);
  if (!node) return;
  hear(name, *node, now);
  node->pulse.beat(computing, progress, now);
}

void HostBarrier::suspect(const std::string& name, Instant now) {
  if (Node* node = active(name)) node->pulse.suspect(now);
}

void HostBarrier::done(const std::string& name, TickTally tally, Instant now) {
  Node* node = active(name);
  if (!node || over_) return;
  hear(name, *node, now);
  if (tally.tick <= node->done) return;  // repeated
  const Tick next = node->schedule.next_after(node->done);
  if (tally.tick != next)
    return fail(name, "tick " + std::to_string(tally.tick) + " is done, but " +
                          std::to_string(next) + " was next");
  node->done = tally.tick;
  node->pulse.progressed = now;
  for (TopicTally& topic : tally.topics) topic.incarnation = node->incarnation;
  const Tick tick = tally.tick;
  if (!record(name, *node, std::move(tally)))
    fail(name, "tick " + std::to_string(tick) +
                   ", repeated after a restart, differs from the first time");
}

bool HostBarrier::record(const std::string& name, Node& node, TickTally tally) {
  tally.digest = content_digest(name, tally);
  const auto at = std::ranges::lower_bound(node.manifests, tally.tick, {}, &TickTally::tick);
  if (at == node.manifests.end() || at->tick != tally.tick) {
    node.manifests.insert(at, std::move(tally));
    return true;
  }
  if (at->digest != tally.digest) return false;
  *at = std::move(tally);  // the sequence numbers are those of the new process
  return true;
}

void HostBarrier::leave(const std::string& name, bool interrupted) {
  Node* node = active(name);
  if (!node) return;
  node->left = true;
  report(News::What::lost, name, *node, interrupted ? "was interrupted" : "left before the end");
}

void HostBarrier::fail(const std::string& name, const std::string& reason) {
  if (Node* node = active(name)) report(News::What::failed, name, *node, reason);
}

void HostBarrier::give_up(const std::string& name) {
  Node* node = active(name);
  if (!node || node->silent || !node->pulse.suspected) return;
  node->silent = true;
  report(News::What::lost, name, *node, "has closed its connection");
}

void HostBarrier::repeat_news() {
  for (const auto& [name, node] : nodes_)
    if (node.silent || node.left)
      report(News::What::lost, name, node, node.left ? "left before the end" : "is silent");
    else
      report(News::What::found, name, node, "");
}

void HostBarrier::check(Instant now) {
  for (auto& [name, node] : nodes_) {
    if (node.left || node.silent) continue;
    const std::string trouble = node.pulse.trouble(limits_, !over_, now);
    if (trouble.empty()) continue;
    report(News::What::lost, name, node, trouble);
    (over_ ? node.left : node.silent) = true;
  }
}

void HostBarrier::excuse(Instant since, Instant now) {
  for (auto& [name, node] : nodes_) node.pulse.excuse(since, now);
}

void HostBarrier::settled(Tick tick) {
  for (auto& [name, node] : nodes_)
    while (!node.manifests.empty() && node.manifests.front().tick <= tick)
      node.manifests.pop_front();
}

Tick HostBarrier::slowest() const {
  Tick slowest = no_tick;
  for (const auto& [name, node] : nodes_) {
    slowest = std::min(slowest, node.reaches());
    if (slowest <= taken_) break;  // the slowest
  }
  return slowest;
}

std::optional<TickTally> HostBarrier::take_done(Tick granted) {
  if (nodes_.empty() || !joining_.empty() || taken_ >= std::min(slowest(), granted) ||
      !missing().empty())
    return std::nullopt;
  TickTally all{++taken_, {}, 0};
  for (auto& [name, node] : nodes_) {
    const auto at = std::ranges::lower_bound(node.manifests, taken_, {}, &TickTally::tick);
    if (at == node.manifests.end() || at->tick != taken_) continue;
    all.topics.insert(all.topics.end(), at->topics.begin(), at->topics.end());
    all.digest += at->digest;
  }
  return all;
}

bool HostBarrier::all_ready() const {
  return !nodes_.empty() && joining_.empty() && missing().empty() &&
         std::all_of(nodes_.begin(), nodes_.end(), [](const auto& entry) {
           return entry.second.ready && !entry.second.silent && !entry.second.left;
         });
}

std::vector<std::string> HostBarrier::missing() const {
  std::vector<std::string> names;
  for (const std::string& name : expected_)
    if (!nodes_.contains(name)) names.push_back(name);
  return names;
}

std::vector<std::string> HostBarrier::holding() const {
  std::vector<std::string> names = missing();
  for (const auto& [name, node] : nodes_)
    if (node.silent || node.left) names.push_back(name);
  if (!names.empty() || nodes_.empty()) return names;
  const Tick last = slowest();
  for (const auto& [name, node] : nodes_)
    if (node.reaches() == last) names.push_back(name);
  return names;
}

bool HostBarrier::deserted() const {
  return std::ranges::all_of(nodes_, [](const auto& entry) { return entry.second.left; });
}

}  // namespace dmise
