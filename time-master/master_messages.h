#pragma once
#include "dmise/v1/node.pb.h"
#include "dmise/v1/time.pb.h"
#include "nodes/runtime/protocol/peer_directory.h"
#include "time-master/coordinator.h"

// Conversion between the coordinator's types and messages.
namespace dmise {

/// Converts a valid Join.
Coordinator::Request request_of(const v1::Join& join);
TickTally tally_of(const v1::Done& done);

/// Adds a topic's manifest of `tick` to a grant.
void add_published(v1::Grant* grant, Tick tick, const TopicTally& topic);

/// `topology` as needed by the process `name`.
v1::Topology topology_for(const std::string& name, v1::Topology topology,
                          const Coordinator& coordinator);

/// Sets the current grant, without manifests.
void describe(v1::Grant* grant, std::uint64_t run_id, const Coordinator& coordinator);

/// Sets the state of the clock and its nodes for `status` and observers.
void describe(v1::Endpoints* endpoints, const Coordinator& coordinator);

/// What a request asks for, in words for the log.
std::string request_text(const v1::Control& control);

/// Executes `control`.
void apply(const v1::Control& control, Coordinator& coordinator, Instant now);

}  // namespace dmise
