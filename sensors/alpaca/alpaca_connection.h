#pragma once
#include "nodes/web/connection.h"
#include "sensors/alpaca/alpaca_answer.h"
#include "sensors/alpaca/alpaca_server.h"

namespace dmise {

/// State of the server, used on its thread only.
struct AlpacaHub {
  const AlpacaServerOptions& options;
  Connections& connections;
  const Observatory& observatory;
  AlpacaDevices devices;
  std::uint32_t transactions = 0;  // that were begun
};

/// Starts to answer the requests that arrive over a socket.
void serve_alpaca(AlpacaHub& hub, tcp::socket socket);

/// The values of the management API, JSON.
std::string description_json(const AlpacaHub& hub);
std::string configured_devices_json(const AlpacaHub& hub);
/// The page at /setup.
std::string setup_page(const AlpacaHub& hub);

}  // namespace dmise
