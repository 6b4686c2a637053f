#pragma once
#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>

namespace dmise {

/// Kinds of messages to viewers. Each message has the whole state of its kind, so the newest
/// replaces all before.
enum class MessageSlot {
  run,
  status,
  roster,
  objects,
  sensors,
  detections,
  tracks,
  tasks,
  truth,  // only for viewers that may see it
  notice,
  count
};
inline constexpr std::size_t slot_count = std::size_t(MessageSlot::count);

/// A message to viewers: JSON, or the binary layout of `encode_objects`.
struct ViewerMessage {
  std::string bytes;
  bool binary = false;
};
using SharedMessage = std::shared_ptr<const ViewerMessage>;

/// The newest message of each kind, passed from the thread that observes the run to the one that
/// serves viewers. A slow viewer misses messages; nothing is queued.
class LatestMessages {
 public:
  struct Slot {
    SharedMessage message;      // null: there is none
    std::uint64_t version = 0;  // counts the messages of this kind
  };

  void set(MessageSlot slot, ViewerMessage message) {
    auto shared = std::make_shared<const ViewerMessage>(std::move(message));
    const std::lock_guard lock(mutex_);
    auto& place = slots_[std::size_t(slot)];
    place.message = std::move(shared);
    ++place.version;
  }
  void forget(MessageSlot slot) {
    const std::lock_guard lock(mutex_);
    slots_[std::size_t(slot)].message.reset();
  }
  std::array<Slot, slot_count> all() const {
    const std::lock_guard lock(mutex_);
    return slots_;
  }
  SharedMessage of(MessageSlot slot) const {
    const std::lock_guard lock(mutex_);
    return slots_[std::size_t(slot)].message;
  }

 private:
  mutable std::mutex mutex_;
  std::array<Slot, slot_count> slots_;
};

}  // namespace dmise
