#pragma once
#include <string>
#include <string_view>

#include "core/sim/message.h"
#include "nodes/wire/envelope.h"

namespace dmise {

/// A serialised state: third and fourth frame.
struct Encoded {
  MessageKind kind = MessageKind::watermark;
  std::string payload;
  std::string arrays;
};

/// Serialises any state; `decode` restores it to the bit. Throws `Refused` (reason `value`, naming
/// the field) if the state violates `state_rules.h`: a state that would be refused is never sent.
Encoded encode(const State& state);

/// Inverse of `encode`. Throws `Refused`.
State decode(MessageKind kind, std::string_view payload, std::string_view arrays);

}  // namespace dmise
