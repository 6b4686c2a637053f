#pragma once
#include <atomic>
#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <thread>

#include "nodes/runtime/process/event.h"
#include "nodes/runtime/protocol/kept_frames.h"
#include "nodes/runtime/transport/peer_monitor.h"

namespace dmise {

/// The frame endpoint of a sensor: a thread that answers requests for frames (docs/wire.md,
/// Frames). A reader gets one answer for each request, so that nothing accumulates for a reader
/// that does not read. The sensor waits for no reader.
class FrameServer {
 public:
  static constexpr int max_readers = 64;  // connections; beyond, the oldest are closed
  /// Answers under way, of files in memory; requests beyond wait.
  static constexpr std::int64_t max_under_way_bytes = std::int64_t(256) << 20;
  /// Answers with a frame that one reader has not read; its next request waits.
  static constexpr int max_unread = 2;

  /// Settings of the socket, before it is bound.
  static zmq::socket_t make_socket_of(zmq::context_t& context);

  /// `socket`: of `make_socket_of`, bound. `frames` must outlive this.
  FrameServer(zmq::context_t& context, zmq::socket_t socket, KeptFrames& frames,
              std::uint64_t run_id);
  ~FrameServer();
  FrameServer(const FrameServer&) = delete;
  FrameServer& operator=(const FrameServer&) = delete;

  /// The sensor makes no more frames: returns when all readers know, when no request has arrived
  /// for `quiet`, or after five times that.
  void finish(std::chrono::nanoseconds quiet);

 private:
  struct Reader {
    std::uint64_t order = 0;  // place among all requests
    bool waits = false;
    v1::FrameRequest request;
    std::shared_ptr<std::atomic<int>> unread = std::make_shared<std::atomic<int>>(0);
  };
  void run();
  void receive_requests();
  void answer_requests();
  void send(const std::string& peer, Reader& reader, const KeptFrames::Answer& answer);
  void look_at_connections();

  zmq::socket_t socket_;
  KeptFrames& frames_;
  std::uint64_t run_id_;
  PeerMonitor peers_;
  std::map<std::string, Reader> readers_;  // by routing id
  std::uint64_t requests_ = 0;
  std::shared_ptr<std::atomic<std::int64_t>> under_way_bytes_;
  Event changed_, quit_;
  std::atomic<std::int64_t> finishing_ns_{0}, quiet_ns_{0};  // since when; 0: not yet
  std::chrono::nanoseconds asked_{0};                        // last
  std::thread thread_;                                       // last: it uses all of the above
};

}  // namespace dmise
