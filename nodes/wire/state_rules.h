#pragma once
#include "core/sim/message.h"
#include "nodes/wire/envelope.h"

// What a state must be to have a meaning: numbers finite and in range, sizes that agree, rotations
// that rotate, texts in UTF-8.
namespace dmise {

/// Throws `Refused` (reason `value`) naming the field.
void check(const State& state);

/// Throws `Refused` (reason `topic`) unless a state of this kind may travel on `topic`, and (reason
/// `tick`) unless the tick and time that it names are those of the envelope.
void check_place(const std::string& topic, const Envelope& envelope, const State& state);

}  // namespace dmise
