#pragma once
#include "clients/cpp/node.h"
#include "dmise/v1/own_node.pb.h"

namespace dmise {

/// What a model says of a tick as the states that its node publishes. Throws `Error` if it is of
/// another number of objects than `begin`, or lacks the attitude of one that is turned.
ObjectStates said_states(const ObjectStateList& said, const v1::OwnNodeBegin& begin, Tick tick,
                         SimTime time);

}  // namespace dmise
