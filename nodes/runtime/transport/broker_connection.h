#pragma once
#include <cstdint>
#include <string>

#include "nodes/runtime/transport/socket.h"

namespace dmise {

/// Connection of a socket to the broker of a run.
class BrokerConnection {
 public:
  explicit BrokerConnection(zmq::socket_t& socket) : socket_(socket) {}

  bool known() const { return !endpoint_.empty(); }

  /// Connects to the broker, reconnecting if another broker replaced it at the same address: ZeroMQ
  /// never reconnects to an address where it met a socket of the wrong type, and another process
  /// may have used the address in between.
  void follow(const std::string& endpoint, std::uint64_t incarnation, const Security& security = {},
              const std::string& password = "") {
    if (endpoint == endpoint_ && incarnation == incarnation_) return;
    if (known()) socket_.disconnect(endpoint_);
    endpoint_ = endpoint;
    incarnation_ = incarnation;
    Security with_password = security;
    with_password.set_password(password);
    connect_to(socket_, endpoint_, with_password, broker_name);
  }

 private:
  zmq::socket_t& socket_;
  std::string endpoint_;
  std::uint64_t incarnation_ = 0;
};

}  // namespace dmise
