#pragma once
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <zmq.hpp>

#include "nodes/runtime/transport/peer_monitor.h"
#include "time-master/stranger_queue.h"

namespace dmise {

/// One message to the time-master.
struct ControlMessage {
  zmq::message_t sender;  // routing id
  zmq::message_t body;
  std::string_view from() const { return sender.to_string_view(); }
};

/// What comes to the time-master's ROUTER, in passes of bounded length, so that the clock is looked
/// at between two: first what comes from those for whom the clock waits, then, if there is time,
/// the others in turns.
class ControlInbox {
 public:
  /// Takes a message, or leaves it to its turn among strangers by returning false.
  using Take = std::function<bool(ControlMessage&)>;

  ControlInbox(zmq::socket_t& router, PeerMonitor& connections)
      : router_(router), connections_(connections), strangers_(StrangerLimits{}) {}

  /// Reads what has come, and offers each message to `take`. True when nothing is left to read.
  bool read(const Take& take);
  /// Hands over what has waited and is due.
  void hear_strangers(const std::function<void(ControlMessage&)>& hear);
  /// When `hear_strangers` has something to do, if it has.
  std::optional<std::chrono::nanoseconds> next_due();
  /// Messages ignored since the last call: of peers that send too many, too large or of too many
  /// frames.
  std::uint64_t take_ignored() { return std::exchange(ignored_, 0) + strangers_.take_ignored(); }

 private:
  bool receive(ControlMessage* message);

  zmq::socket_t& router_;
  PeerMonitor& connections_;
  StrangerQueue<ControlMessage> strangers_;
  std::uint64_t ignored_ = 0;
};

}  // namespace dmise
