#pragma once
#include <memory>
#include <string>
#include <string_view>

#include "core/sim/message.h"
#include "nodes/wire/envelope.h"

namespace dmise {

/// A state as it travels: third and fourth frame.
struct Encoded {
  MessageKind kind = MessageKind::watermark;
  std::string payload;
  std::string arrays;
};

/// Any state; `decode` gives it back bit by bit. Throws `Refused` (reason `value`, naming the
/// field) when the state breaks the rules of `state_rules.h`: what would be refused is not sent.
Encoded encode(const State& state);

/// Throws `Refused`.
State decode(MessageKind kind, std::string_view payload, std::string_view arrays);

}  // namespace dmise
