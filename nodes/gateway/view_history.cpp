#include "nodes/gateway/view_history.h"

#include <algorithm>

namespace dmise {
namespace {

/// Size of the messages that the snapshot before does not have.
std::size_t own_bytes(const ViewSnapshot& snapshot, const ViewSnapshot* before) {
  std::size_t sum = 0;
  for (const auto& message : snapshot.messages)
    if (!before || std::ranges::find(before->messages, message) == before->messages.end())
      sum += message->bytes.size();
  return sum;
}

}  // namespace

void ViewHistory::add(ViewSnapshot snapshot) {
  const std::lock_guard lock(mutex_);
  if (!snapshots_.empty() && (snapshot.time_s <= snapshots_.back().time_s ||
                              snapshot.time_s < snapshots_.back().time_s + spacing_s_))
    return;
  bytes_ += own_bytes(snapshot, snapshots_.empty() ? nullptr : &snapshots_.back());
  snapshots_.push_back(std::move(snapshot));
  while (snapshots_.size() > 2 && (snapshots_.size() > max_snapshots_ || bytes_ > max_bytes_))
    thin();
}

void ViewHistory::clear() {
  const std::lock_guard lock(mutex_);
  snapshots_.clear();
  spacing_s_ = 0.0;
  bytes_ = 0;
}

std::optional<ViewSnapshot> ViewHistory::at(double time_s) const {
  const std::lock_guard lock(mutex_);
  if (snapshots_.empty()) return std::nullopt;
  const auto after =
      std::ranges::upper_bound(snapshots_, time_s, {}, [](const auto& s) { return s.time_s; });
  return after == snapshots_.begin() ? snapshots_.front() : *std::prev(after);
}

ViewHistory::Span ViewHistory::span() const {
  const std::lock_guard lock(mutex_);
  if (snapshots_.empty()) return {};
  return {snapshots_.front().time_s, snapshots_.back().time_s, snapshots_.size(), bytes_};
}

void ViewHistory::thin() {
  std::deque<ViewSnapshot> kept;
  for (std::size_t i = 0; i < snapshots_.size(); i += 2) kept.push_back(std::move(snapshots_[i]));
  snapshots_ = std::move(kept);
  bytes_ = 0;
  for (std::size_t i = 0; i < snapshots_.size(); ++i)
    bytes_ += own_bytes(snapshots_[i], i == 0 ? nullptr : &snapshots_[i - 1]);
  spacing_s_ =
      (snapshots_.back().time_s - snapshots_.front().time_s) / double(snapshots_.size() - 1);
}

}  // namespace dmise
