#pragma once
#include <string>

namespace dmise {

/// "tcp://HOST:PORT" with HOST resolved to an IPv4 address; other transports and names of
/// interfaces are unchanged. Throws `Error` "ADDRESS: reason" if the name cannot be resolved
/// or is a number of IPv6.
std::string numeric_address(const std::string& address);

/// "tcp://A.B.C.D:0" with the address of this machine (or container) on the route to the numeric
/// address `peer`. Throws `Error` if there is no route.
std::string address_towards(const std::string& peer);

}  // namespace dmise
