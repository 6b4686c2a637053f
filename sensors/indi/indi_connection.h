#pragma once
#include <string>
#include <vector>

#include "nodes/web/connection.h"
#include "sensors/indi/indi_devices.h"
#include "sensors/indi/indi_server.h"

namespace dmise {

class IndiConnection;

/// State of the server, used on its thread only.
struct IndiHub {
  const IndiServerOptions& options;
  Connections& connections;
  Observatory& observatory;
  IndiDevices devices;
  std::vector<IndiConnection*> clients = {};

  /// Tells each client what it wants to know.
  void tell(const std::vector<IndiNews>& news);
  void tell_changes();
};

/// Starts to hear a client.
void serve_indi(IndiHub& hub, tcp::socket socket);

}  // namespace dmise
