#include "nodes/runtime/transport/socket.h"

#include <cctype>

#include "core/base/error.h"

namespace dmise {
namespace {

constexpr std::size_t copied_bytes = 16384;  // larger frames are passed without copying

std::string reason(const zmq::error_t& error) {
  std::string text = error.what();
  if (!text.empty()) text[0] = static_cast<char>(std::tolower(text[0]));
  return text;
}

using Owner = std::shared_ptr<const Frames>;

void release_frames(void*, void* owner) { delete static_cast<Owner*>(owner); }

zmq::message_t frame_of(const Owner& frames, const std::string& part) {
  if (part.size() < copied_bytes) return zmq::message_t(part.data(), part.size());
  return zmq::message_t(const_cast<char*>(part.data()), part.size(), release_frames,
                        new Owner(frames));
}

}  // namespace

zmq::socket_t make_socket(zmq::context_t& context, zmq::socket_type type,
                          std::int64_t max_message_bytes) {
  zmq::socket_t socket(context, type);
  socket.set(zmq::sockopt::linger, 0);
  const bool publishes = type == zmq::socket_type::pub || type == zmq::socket_type::xpub;
  socket.set(zmq::sockopt::maxmsgsize, publishes ? max_subscription_bytes : max_message_bytes);
  socket.set(zmq::sockopt::handshake_ivl, 5000);
  socket.set(zmq::sockopt::reconnect_ivl, 20);
  socket.set(zmq::sockopt::reconnect_ivl_max, 500);
  const bool serves = type == zmq::socket_type::router;
  socket.set(zmq::sockopt::sndhwm, serves ? max_unread : 0);
  socket.set(zmq::sockopt::rcvhwm, serves ? max_waiting : 0);
  return socket;
}

std::string bind_to(zmq::socket_t& socket, const std::string& address, const Security& security,
                    Domain domain) {
  security.serve(socket, address, domain);
  try {
    socket.bind(address);
  } catch (const zmq::error_t& error) {
    throw Error(address + ": " + reason(error));
  }
  return socket.get(zmq::sockopt::last_endpoint);
}

void connect_to(zmq::socket_t& socket, const std::string& address, const Security& security,
                const std::string& peer) {
  security.call(socket, address, peer);
  try {
    socket.connect(address);
  } catch (const zmq::error_t& error) {
    throw Error(address + ": " + reason(error));
  }
}

std::string any_port(const std::string& address) {
  return address.substr(0, address.rfind(':')) + ":0";
}

std::vector<zmq::message_t> receive(zmq::socket_t& socket) {
  std::vector<zmq::message_t> message;
  zmq::message_t frame;
  if (!socket.recv(frame, zmq::recv_flags::dontwait)) return message;
  message.push_back(std::move(frame));
  for (bool more = message.back().more(); more;) {  // frames of a message arrive together
    zmq::message_t next;
    if (!socket.recv(next, zmq::recv_flags::none)) break;
    more = next.more();
    if (message.size() < max_frames) message.push_back(std::move(next));
  }
  return message;
}

std::optional<zmq::message_t> receive_one(zmq::socket_t& socket) {
  zmq::message_t frame;
  if (!socket.recv(frame, zmq::recv_flags::dontwait)) return std::nullopt;
  if (!frame.more()) return frame;
  while (frame.more() && socket.recv(frame, zmq::recv_flags::none)) {
  }
  return zmq::message_t();
}

void send(zmq::socket_t& socket, const std::shared_ptr<const Frames>& frames,
          std::string_view prefix) {
  if (!prefix.empty()) socket.send(zmq::buffer(prefix), zmq::send_flags::sndmore);
  socket.send(zmq::buffer(frames->topic), zmq::send_flags::sndmore);
  socket.send(zmq::buffer(frames->envelope), zmq::send_flags::sndmore);
  const bool arrays = !frames->arrays.empty();
  socket.send(frame_of(frames, frames->payload),
              arrays ? zmq::send_flags::sndmore : zmq::send_flags::none);
  if (arrays) socket.send(frame_of(frames, frames->arrays), zmq::send_flags::none);
}

std::vector<std::string_view> views(const std::vector<zmq::message_t>& message) {
  std::vector<std::string_view> frames;
  frames.reserve(message.size());
  for (const auto& frame : message) frames.push_back(frame.to_string_view());
  return frames;
}

void wait_for(std::vector<zmq::pollitem_t>& items, std::chrono::nanoseconds at_most) {
  const auto ms = std::chrono::ceil<std::chrono::milliseconds>(at_most);
  try {
    zmq::poll(items, std::max(ms, std::chrono::milliseconds(0)));
  } catch (const zmq::error_t& error) {
    if (error.num() != EINTR) throw;  // interrupted by a signal, whose event is set
  }
}

}  // namespace dmise
