#include "time-master/control_inbox.h"

#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/transport/socket.h"

namespace dmise {
namespace {

using std::chrono::milliseconds;

// Length of a pass, after which the clock is checked.
constexpr int max_messages = 2000;
constexpr int max_strangers = 64;
constexpr milliseconds max_time{5};
constexpr milliseconds max_time_of_strangers{2};
constexpr int looks_at_time = 16;  // messages between two checks of the time
// A Join with 4,000 topics of usual length; the clock's own messages may be longer.
constexpr std::size_t longest_of_a_stranger = 256 << 10;

}  // namespace

bool ControlInbox::receive(ControlMessage* message) {
  while (router_.recv(message->sender, zmq::recv_flags::dontwait)) {
    int frames = 1;
    // Frames of a message arrive together.
    for (bool more = message->sender.more(); more; more = message->body.more()) {
      if (!router_.recv(message->body, zmq::recv_flags::none)) break;
      connections_.count_read(message->body);
      ++frames;
    }
    if (frames == 2) return true;
    ++ignored_;
  }
  return false;
}

bool ControlInbox::read(const Take& take) {
  const auto until = now() + max_time;
  ControlMessage message;
  for (int count = 1; count <= max_messages; ++count) {
    if (!receive(&message)) return true;
    if (!take(message)) {
      const std::size_t bytes = message.body.size();
      const std::string from(message.from());
      if (bytes > longest_of_a_stranger)
        ++ignored_;
      else
        strangers_.push(from, std::move(message), bytes);
      message = {};
    }
    if (count % looks_at_time == 0 && now() >= until) break;
  }
  return false;
}

std::optional<std::chrono::nanoseconds> ControlInbox::next_due() {
  return strangers_.next_due(now());
}

void ControlInbox::deliver_strangers(const std::function<void(ControlMessage&)>& hear) {
  if (strangers_.size() == 0) return;
  const auto until = now() + max_time_of_strangers;
  for (int count = 0; count < max_strangers && now() < until; ++count) {
    auto message = strangers_.take(now());
    if (!message) return;
    hear(*message);
  }
}

}  // namespace dmise
