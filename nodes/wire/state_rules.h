#pragma once
#include "core/sim/message.h"
#include "nodes/wire/envelope.h"

// Validity of states: finite numbers in range, consistent sizes, orthonormal rotations, UTF-8
// texts.
namespace dmise {

/// Throws `Refused` (reason `value`) naming the invalid field.
void check(const State& state);

/// Throws `Refused` (reason `topic`) if a state of this kind may not travel on `topic`, and (reason
/// `tick`) if its tick or time differ from the envelope's.
void check_place(const std::string& topic, const Envelope& envelope, const State& state);

}  // namespace dmise
