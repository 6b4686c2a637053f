#pragma once
#include <cstdint>
#include <string>
#include <string_view>

#include "core/base/error.h"

namespace dmise {

/// Reasons for refusing a message, as counted.
enum class Refusal : std::uint8_t {
  frames,          // number or size of the frames
  envelope,        // not an Envelope
  seal,            // CRC-32C of the message
  schema_version,  // another version of the wire
  run,             // another run
  topic,           // unknown, or not the publisher's, or of another kind
  tick,            // outside the run, or tick and time disagree
  payload,         // not the message that the envelope announces, or sizes that disagree
  value,           // a number that is not finite or out of range, or invalid text
  count
};

std::string_view name(Refusal reason);

class Refused : public Error {
 public:
  Refused(Refusal reason, const std::string& what) : Error(what), reason(reason) {}
  Refusal reason;
};

}  // namespace dmise
