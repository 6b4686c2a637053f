#pragma once
#include <string>

namespace dmise {

/// "tcp://HOST:PORT" with HOST as the IPv4 address that its name stands for now; anything else than
/// tcp, and names of interfaces, as they are. Throws `Error` "ADDRESS: reason" when nobody knows
/// the name.
std::string numeric_address(const std::string& address);

/// "tcp://A.B.C.D:0": the address of this machine (or container) on the way to the numeric address
/// `peer`, as others see it. Throws `Error` when there is no way.
std::string address_towards(const std::string& peer);

}  // namespace dmise
