#pragma once
#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
#include <zmq.hpp>

#include "nodes/runtime/security/security.h"
#include "nodes/wire/envelope.h"

// Sockets with the settings of this project: size limits, handshake timeouts, linger only for last
// messages.
namespace dmise {

inline constexpr std::int64_t max_control_bytes = 1 << 20;
inline constexpr std::int64_t max_data_bytes = max_array_bytes + (1 << 20);

/// Largest inbound message of publishing sockets: subscriptions, which libzmq removes recursively,
/// and the CURVE handshake.
inline constexpr std::int64_t max_subscription_bytes = 1024;
/// Number of frames kept of one message; longer messages are truncated and then refused.
inline constexpr std::size_t max_frames = 8;
/// Messages queued for a peer of a ROUTER, or for a subscriber of a public socket, that does not
/// read; further ones are dropped.
inline constexpr int max_unread = 4096;
/// Unread answers where a reply may be a whole tick of states; peers repeat unanswered requests.
inline constexpr int max_unread_answers = 256;
/// Largest request for published messages.
inline constexpr std::int64_t max_question_bytes = 4096;
/// Requests queued at a ROUTER per peer; others wait at the peer.
inline constexpr int max_waiting = 1024;
/// Bytes of one connection that may be queued unread: of control messages, of requests, and of all
/// subscriptions. In frames of one byte they take twenty times as much memory.
inline constexpr std::int64_t max_unheard_bytes = 4 << 20;
inline constexpr std::int64_t max_unheard_questions_bytes = 1 << 20;
inline constexpr std::int64_t max_subscriptions_bytes = 512 << 10;

/// Queues are unlimited, because those of a run are bounded by its window, except at a ROUTER.
zmq::socket_t make_socket(zmq::context_t& context, zmq::socket_type type,
                          std::int64_t max_message_bytes);

/// Binds and returns the address with its real port. Throws `Error` "ADDRESS: reason", and
/// `ConfigError` when `security` does not allow it.
std::string bind_to(zmq::socket_t& socket, const std::string& address,
                    const Security& security = {}, Domain domain = Domain::control);

/// `peer`: name of the process there. Throws `Error` "ADDRESS: reason" for an invalid address, and
/// `ConfigError` if `security` does not allow it.
void connect_to(zmq::socket_t& socket, const std::string& address, const Security& security = {},
                const std::string& peer = "");

/// `address` ("tcp://HOST:PORT") with port 0: any free port on the same host.
std::string any_port(const std::string& address);

/// All frames of one message, up to `max_frames`; empty if no message is waiting.
std::vector<zmq::message_t> receive(zmq::socket_t& socket);
/// The only frame of a message; empty if no message is waiting or it has several frames.
std::optional<zmq::message_t> receive_one(zmq::socket_t& socket);

/// Sends a message of three or four frames; large frames are not copied. `prefix`: routing id, if
/// any.
void send(zmq::socket_t& socket, const std::shared_ptr<const Frames>& frames,
          std::string_view prefix = {});

std::vector<std::string_view> views(const std::vector<zmq::message_t>& message);

/// Serialises a Protocol Buffers message to a frame.
template <class M>
zmq::message_t to_frame(const M& message) {
  zmq::message_t frame(message.ByteSizeLong());
  message.SerializeToArray(frame.data(), static_cast<int>(frame.size()));
  return frame;
}
template <class M>
bool from_frame(const zmq::message_t& frame, M* message) {
  return message->ParseFromArray(frame.data(), static_cast<int>(frame.size()));
}

/// Waits until one of `items` is readable or the time is over.
void wait_for(std::vector<zmq::pollitem_t>& items, std::chrono::nanoseconds at_most);

}  // namespace dmise
