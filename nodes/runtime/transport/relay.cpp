#include "nodes/runtime/transport/relay.h"

#include <spdlog/spdlog.h>

#include <vector>

#include "nodes/runtime/transport/socket.h"
#include "nodes/wire/envelope.h"
#include "nodes/wire/refusal.h"

namespace dmise {
namespace {

/// Whether the sender of a message may use the publisher's name in its envelope.
bool is_allowed(std::vector<zmq::message_t>& message, MayPublish may_publish) {
  try {
    return may_publish(message[0], std::string(open(views(message)).publisher));
  } catch (const Refused&) {
    return false;
  }
}

}  // namespace

int relay_messages(zmq::socket_t& from, zmq::socket_t& to) {
  int messages = 0;
  zmq::message_t frame;
  for (bool more = false; more || messages < relay_burst;) {
    if (!from.recv(frame, more ? zmq::recv_flags::none : zmq::recv_flags::dontwait)) break;
    messages += !more;
    more = frame.more();
    to.send(frame, more ? zmq::send_flags::sndmore : zmq::send_flags::none);
  }
  return messages;
}

int relay_checked(zmq::socket_t& from, zmq::socket_t& to, MayPublish may_publish,
                  std::uint64_t* refused) {
  int messages = 0;
  for (auto message = receive(from); !message.empty(); message = receive(from)) {
    if (is_allowed(message, may_publish)) {
      for (std::size_t i = 0; i < message.size(); ++i)
        to.send(message[i],
                i + 1 < message.size() ? zmq::send_flags::sndmore : zmq::send_flags::none);
    } else if ((*refused)++ == 0) {
      spdlog::warn("refused a message of {} under another name", sender_of(message[0]));
    }
    if (++messages >= relay_burst) break;
  }
  return messages;
}

int relay_subscriptions(zmq::socket_t& from, zmq::socket_t& to) {
  int messages = 0;
  for (auto message = receive(from); !message.empty(); message = receive(from)) {
    const std::string_view frame = message[0].to_string_view();
    const bool subscription =
        message.size() == 1 && !frame.empty() && (frame[0] == 0 || frame[0] == 1);
    if (subscription && frame.size() <= 1 + max_topic_bytes)
      to.send(message[0], zmq::send_flags::none);
    if (++messages >= relay_burst) break;
  }
  return messages;
}

}  // namespace dmise
