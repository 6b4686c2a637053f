#include "nodes/runtime/relay.h"

namespace dmise {

int pass_on(zmq::socket_t& from, zmq::socket_t& to) {
  int messages = 0;
  zmq::message_t frame;
  while (messages < relay_burst && from.recv(frame, zmq::recv_flags::dontwait)) {
    bool more = frame.more();
    to.send(frame, more ? zmq::send_flags::sndmore : zmq::send_flags::none);
    while (more) {
      if (!from.recv(frame, zmq::recv_flags::none)) break;
      more = frame.more();
      to.send(frame, more ? zmq::send_flags::sndmore : zmq::send_flags::none);
    }
    ++messages;
  }
  return messages;
}

}  // namespace dmise
