#include "nodes/runtime/node/frame_server.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <vector>

#include "nodes/runtime/process/monotonic_clock.h"
#include "nodes/runtime/protocol/control_rules.h"
#include "nodes/runtime/transport/socket.h"

namespace dmise {
namespace {

using std::chrono::milliseconds;
using std::chrono::nanoseconds;

constexpr milliseconds look_interval{20};  // between checks of connections, while there are any
constexpr milliseconds idle{1000};
constexpr int requests_at_once = 256;
constexpr std::size_t remembered_readers = 2 * FrameServer::max_readers;
constexpr int unread_ms = 30'000;  // after which the system disconnects a reader that reads nothing

/// Keeps the bytes of an answer until ZeroMQ has sent them.
struct UnderWay {
  FrameBytes fits;
  std::shared_ptr<std::atomic<std::int64_t>> total;
  std::shared_ptr<std::atomic<int>> unread;  // by its reader
};

void release(void*, void* hint) {
  auto* sent = static_cast<UnderWay*>(hint);
  *sent->total -= std::int64_t(sent->fits.bytes.size());
  --*sent->unread;
  delete sent;
}

ConnectionLimits limits() {
  constexpr std::size_t readers = FrameServer::max_readers;
  return {.usual_strangers = readers, .max_strangers = readers, .stranger_bytes = 128 << 10};
}

}  // namespace

zmq::socket_t FrameServer::make_socket_of(zmq::context_t& context) {
  zmq::socket_t socket = make_socket(context, zmq::socket_type::router, max_question_bytes);
  socket.set(zmq::sockopt::sndhwm, FrameServer::max_unread);
  socket.set(zmq::sockopt::rcvhwm, 4);
  socket.set(zmq::sockopt::tcp_maxrt, unread_ms);
  socket.set(zmq::sockopt::linger, 500);  // for last answers
  return socket;
}

FrameServer::FrameServer(zmq::context_t& context, zmq::socket_t socket, KeptFrames& frames,
                         std::uint64_t run_id)
    : socket_(std::move(socket)),
      frames_(frames),
      run_id_(run_id),
      peers_(context, socket_, limits()),
      under_way_bytes_(std::make_shared<std::atomic<std::int64_t>>(0)) {
  frames_.when_changed([this] { changed_.set(); });
  thread_ = std::thread([this] { run(); });
}

FrameServer::~FrameServer() {
  frames_.when_changed([] {});
  quit_.set();
  if (thread_.joinable()) thread_.join();
}

void FrameServer::finish(nanoseconds quiet) {
  quiet_ns_ = quiet.count();
  finishing_ns_ = now().count();
  frames_.end();
  if (thread_.joinable()) thread_.join();
}

void FrameServer::run() {
  auto next_look = now();
  while (!quit_.is_set()) {
    const nanoseconds since{finishing_ns_}, quiet{quiet_ns_};
    const bool ending = since.count() > 0;
    if (ending && (readers_.empty() || now() - std::max(since, asked_) >= quiet ||
                   now() - since >= 5 * quiet))
      return;
    std::vector<zmq::pollitem_t> items{{nullptr, quit_.fd(), ZMQ_POLLIN, 0},
                                       {nullptr, changed_.fd(), ZMQ_POLLIN, 0},
                                       {peers_.handle(), 0, ZMQ_POLLIN, 0},
                                       {socket_.handle(), 0, ZMQ_POLLIN, 0}};
    wait_for(items, ending || peers_.size() > 0 ? look_interval : idle);
    if (items[1].revents) changed_.clear();
    receive_requests();
    if (items[2].revents || now() >= next_look) {
      look_at_connections();
      next_look = now() + look_interval;
    }
    answer_requests();
  }
}

void FrameServer::receive_requests() {
  for (int i = 0; i < requests_at_once; ++i) {
    auto message = receive(socket_);
    if (message.empty()) return;
    for (std::size_t k = 1; k < message.size(); ++k) peers_.count_read(message[k]);
    v1::FrameRequest request;
    if (message.size() != 2 || !from_frame(message[1], &request) || request.run_id() != run_id_ ||
        fault_of(request))
      continue;
    asked_ = now();
    Reader& reader = readers_[message[0].to_string()];
    reader.order = ++requests_;
    reader.waits = true;
    reader.request = request;
    if (readers_.size() > remembered_readers)
      readers_.erase(std::ranges::min_element(
          readers_, {}, [](const auto& reader) { return reader.second.order; }));
  }
}

void FrameServer::answer_requests() {
  for (auto at = readers_.begin(); at != readers_.end();) {
    auto& [peer, reader] = *at;
    std::optional<KeptFrames::Answer> answer;
    if (reader.waits && *reader.unread < max_unread && *under_way_bytes_ < max_under_way_bytes)
      answer = frames_.answer(reader.request, run_id_);
    if (!answer) {
      ++at;
      continue;
    }
    reader.waits = false;
    send(peer, reader, *answer);
    // `finish` does not wait for a reader that knows that the frames are over.
    at = answer->head.status() == v1::FrameAnswer::STATUS_OVER ? readers_.erase(at) : std::next(at);
  }
}

void FrameServer::send(const std::string& peer, Reader& reader, const KeptFrames::Answer& answer) {
  const bool sent = answer.head.status() == v1::FrameAnswer::STATUS_SENT;
  socket_.send(zmq::buffer(peer), zmq::send_flags::sndmore);
  socket_.send(to_frame(answer.head), sent ? zmq::send_flags::sndmore : zmq::send_flags::none);
  if (!sent) return;
  const std::string_view bytes = answer.fits.bytes;
  *under_way_bytes_ += std::int64_t(bytes.size());
  ++*reader.unread;
  zmq::message_t frame(const_cast<char*>(bytes.data()), bytes.size(), release,
                       new UnderWay{answer.fits, under_way_bytes_, reader.unread});
  socket_.send(frame, zmq::send_flags::none);
}

void FrameServer::look_at_connections() {
  for (const std::string& closed : peers_.enforce(now())) spdlog::warn("frames: {}", closed);
  peers_.forget(peers_.broken());
  frames_.set_wanted(peers_.size() > 0);
  if (peers_.size() == 0) readers_.clear();
}

}  // namespace dmise
