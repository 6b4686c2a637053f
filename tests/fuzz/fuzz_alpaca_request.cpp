// What clients send to an observatory's Alpaca server: targets, queries and forms. Each is a call
// or refused with a status of HTTP; numbers of a call are finite.
#include <algorithm>
#include <cmath>
#include <string>
#include <string_view>

#include "nodes/web/access.h"
#include "sensors/alpaca/alpaca_request.h"

namespace {

using namespace dmise;

void require(bool holds) {
  if (!holds) __builtin_trap();
}

template <class Read>
void may_refuse(const Read& read) {
  try {
    read();
  } catch (const BadRequest& error) {
    require(error.status() == 400 || error.status() == 404);
    require(*error.what() != '\0');
  }
}

void check_parameters(const AlpacaParameters& p) {
  for (const char* name : {"Duration", "Axis", "a", ""}) {
    may_refuse([&] { require(std::isfinite(p.number(name))); });
    may_refuse([&] { p.integer(name); });
    may_refuse([&] { p.flag(name); });
    may_refuse([&] {
      for (const char c : p.text(name)) require(static_cast<unsigned char>(c) >= 0x20);
    });
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size == 0) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  const std::string_view target = text.substr(0, text.find('\n'));
  const std::string_view body = text.substr(std::min(target.size() + 1, text.size()));
  may_refuse([&] {
    const AlpacaCall call = parse_alpaca(data[0] % 2 == 1, target, body);
    require(call.token.size() <= 128);
    if (const auto* device = std::get_if<DeviceCall>(&call.what))
      require(device->member.find('/') == std::string::npos);
    check_parameters(call.parameters);
  });
  require(authorization_token(body).size() <= 128);
  return 0;
}
