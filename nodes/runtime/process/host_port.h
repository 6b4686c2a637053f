#pragma once
#include <optional>
#include <string>
#include <string_view>
#include <utility>

// Addresses of TCP as text: HOST:PORT, or [IPv6]:PORT.
namespace dmise {

struct HostPort {
  std::string host = "127.0.0.1";  // without brackets
  int port = 0;                    // 0: any free one
};

/// Returns the host, without its brackets, and the port as they stand in `text`; none where there
/// is no colon, where the host is empty, or has a colon or slash and no brackets.
std::optional<std::pair<std::string_view, std::string_view>> split_host_and_port(
    std::string_view text);

/// Parses HOST:PORT with a port of 0 to 65535; none for anything else.
std::optional<HostPort> host_and_port(std::string_view text);

/// Returns HOST:PORT, with brackets around a host that has a colon.
std::string text_of(const HostPort& address);

}  // namespace dmise
