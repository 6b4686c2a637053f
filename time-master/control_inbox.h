#pragma once
#include <functional>
#include <optional>
#include <string_view>
#include <utility>
#include <zmq.hpp>

#include "nodes/runtime/transport/peer_monitor.h"
#include "time-master/unauthenticated_peers.h"

namespace dmise {

/// One message to the time-master.
struct ControlMessage {
  zmq::message_t sender;  // routing id
  zmq::message_t body;
  std::string_view from() const { return sender.to_string_view(); }
};

/// Reads the time-master's ROUTER in passes of bounded length, so that the clock is checked in
/// between: first messages of processes that the clock waits for, then, if there is time, those of
/// others in turns.
class ControlInbox {
 public:
  /// Handles a message, or returns false to queue it among strangers.
  using Take = std::function<bool(ControlMessage&)>;

  ControlInbox(zmq::socket_t& router, PeerMonitor& connections)
      : router_(router), connections_(connections), strangers_(StrangerLimits{}) {}

  /// Reads waiting messages and offers each to `take`. True if nothing is left to read.
  bool read(const Take& take);
  /// Delivers queued messages that are due.
  void deliver_strangers(const std::function<void(ControlMessage&)>& hear);
  /// When `deliver_strangers` has work, if it has.
  std::optional<std::chrono::nanoseconds> next_due();
  /// Messages ignored since the last call: from peers that send too many, too large ones or too
  /// many frames.
  std::uint64_t take_ignored() { return std::exchange(ignored_, 0) + strangers_.take_ignored(); }

 private:
  bool receive(ControlMessage* message);

  zmq::socket_t& router_;
  PeerMonitor& connections_;
  UnauthenticatedPeers<ControlMessage> strangers_;
  std::uint64_t ignored_ = 0;
};

}  // namespace dmise
