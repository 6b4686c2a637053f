// What clients send to an observatory's INDI server: a stream of elements. It is refused, or
// divided into the same requests wherever its pieces end; numbers are finite.
#include <cmath>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "sensors/indi/indi_request.h"

namespace {

using namespace dmise;

void require(bool holds) {
  if (!holds) __builtin_trap();
}

/// What a server makes of a stream that comes in pieces: a line for each request, then why it
/// ended.
std::string heard(std::string_view text, std::size_t piece) {
  std::string lines;
  IndiStream stream;
  try {
    for (std::size_t at = 0; at < text.size(); at += piece) {
      stream.add(text.substr(at, piece));
      while (const auto element = stream.next()) {
        const auto request = parse_indi(*element);
        lines += element->name + (request ? " asks\n" : "\n");
        if (!request) continue;
        if (const auto* vector = std::get_if<NewIndiVector>(&*request))
          for (const auto& [name, value] : vector->values) {
            require(!name.empty());
            if (const auto number = indi_number(value)) require(std::isfinite(*number));
          }
      }
    }
  } catch (const BadIndi& error) {
    require(*error.what() != '\0');
    lines += error.what();
  }
  return lines;
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const std::string_view text(reinterpret_cast<const char*>(data), size);
  const std::string whole = heard(text, std::max<std::size_t>(size, 1));
  require(heard(text, 1) == whole);
  require(heard(text, 7) == whole);
  if (const auto number = indi_number(text)) require(std::isfinite(*number));
  return 0;
}
