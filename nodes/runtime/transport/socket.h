#pragma once
#include <chrono>
#include <memory>
#include <string>
#include <string_view>
#include <vector>
#include <zmq.hpp>

#include "nodes/runtime/security/security.h"
#include "nodes/wire/envelope.h"

// Sockets as this project uses them: sizes capped, handshakes timed, no lingering but for last
// words.
namespace dmise {

inline constexpr std::int64_t max_control_bytes = 1 << 20;
inline constexpr std::int64_t max_data_bytes = max_array_bytes + (1 << 20);

/// Largest inbound message of sockets that publish: subscriptions, which libzmq walks by recursion
/// when it removes them, and what the handshake with keys needs.
inline constexpr std::int64_t max_subscription_bytes = 1024;
/// Frames of one message that are kept; what has more is cut there, and refused for their number.
inline constexpr std::size_t max_frames = 8;
/// Messages kept for a peer of a ROUTER, or a subscriber on a socket that anybody may reach, who
/// does not read; what comes then is dropped.
inline constexpr int max_unread = 4096;
/// The same where an answer may be a whole tick of states; who has not read it asks again.
inline constexpr int max_unread_answers = 256;
/// A question for what was published.
inline constexpr std::int64_t max_question_bytes = 4096;
/// Requests that wait at a ROUTER, of each peer; the rest waits on its side.
inline constexpr int max_waiting = 1024;
/// Bytes sent over one connection that may be kept unheard: of control messages, of questions for
/// what was published, and of all subscriptions. In frames of one byte they take twenty times as
/// much.
inline constexpr std::int64_t max_unheard_bytes = 4 << 20;
inline constexpr std::int64_t max_unheard_questions_bytes = 1 << 20;
inline constexpr std::int64_t max_subscriptions_bytes = 512 << 10;

/// Queues without limit, for those of a run are bounded by its window; but for a ROUTER's.
zmq::socket_t make_socket(zmq::context_t& context, zmq::socket_type type,
                          std::int64_t max_message_bytes);

/// Binds and returns the address with its real port. Throws `Error` "ADDRESS: reason", and
/// `ConfigError` when `security` does not allow it.
std::string bind_to(zmq::socket_t& socket, const std::string& address,
                    const Security& security = {}, Domain domain = Domain::control);

/// `peer`: who is there. Throws `Error` "ADDRESS: reason" when the address can't be one, and
/// `ConfigError` when `security` does not allow it.
void connect_to(zmq::socket_t& socket, const std::string& address, const Security& security = {},
                const std::string& peer = "");

/// `address` ("tcp://HOST:PORT") with port 0: any free one on the same host.
std::string any_port(const std::string& address);

/// All frames of one message, up to `max_frames`, or none when there is no message now.
std::vector<zmq::message_t> receive(zmq::socket_t& socket);
/// The only frame of a message; empty when there is no message now or it has several.
std::optional<zmq::message_t> receive_one(zmq::socket_t& socket);

/// Sends a message of three or four frames; large frames are not copied. `prefix`: routing id, if
/// any.
void send(zmq::socket_t& socket, const std::shared_ptr<const Frames>& frames,
          std::string_view prefix = {});

std::vector<std::string_view> views(const std::vector<zmq::message_t>& message);

/// One message of Protocol Buffers as a frame.
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
