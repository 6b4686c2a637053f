#include "nodes/runtime/process/host_port.h"

#include <charconv>
#include <cstdint>

namespace dmise {

std::optional<std::pair<std::string_view, std::string_view>> split_host_and_port(
    std::string_view text) {
  const auto colon = text.rfind(':');
  if (colon == text.npos || colon == 0) return std::nullopt;
  std::string_view host = text.substr(0, colon);
  if (host.front() == '[') {
    if (host.back() != ']' || host.size() <= 2) return std::nullopt;
    host = host.substr(1, host.size() - 2);
  } else if (host.find_first_of(":/ ") != host.npos) {
    return std::nullopt;
  }
  return std::pair(host, text.substr(colon + 1));
}

std::optional<HostPort> host_and_port(std::string_view text) {
  const auto parts = split_host_and_port(text);
  if (!parts) return std::nullopt;
  const auto [host, port] = *parts;
  std::uint16_t number = 0;
  const char* const end = port.data() + port.size();
  if (std::from_chars(port.data(), end, number) != std::from_chars_result{end, std::errc{}})
    return std::nullopt;
  return HostPort{std::string(host), number};
}

std::string text_of(const HostPort& address) {
  const bool has_colon = address.host.find(':') != std::string::npos;
  return (has_colon ? "[" + address.host + "]" : address.host) + ":" + std::to_string(address.port);
}

}  // namespace dmise
