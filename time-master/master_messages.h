#pragma once
#include "dmise/v1/node.pb.h"
#include "dmise/v1/time.pb.h"
#include "nodes/runtime/protocol/peer_directory.h"
#include "time-master/coordinator.h"

// What the time-master hears and says: coordinator's types <-> messages.
namespace dmise {

v1::Phase to_wire(Phase phase);

/// What a process says of itself in a Join without fault.
Coordinator::Request request_of(const v1::Join& join);
TickTally tally_of(const v1::Done& done);

/// Adds a tick's manifest to a grant, but for topics that are not in `wanted`.
void add_published(v1::Grant* grant, const std::set<std::string, std::less<>>& wanted,
                   const TickTally& tally);

/// `topology` as the process `name` needs it.
v1::Topology topology_for(const std::string& name, v1::Topology topology,
                          const Coordinator& coordinator);

/// Sets the grant as it is now, without manifests.
void describe(v1::Grant* grant, std::uint64_t run_id, const Coordinator& coordinator);

/// Sets what `status` and observers want to know of the clock and its nodes.
void describe(v1::Endpoints* endpoints, const Coordinator& coordinator);

/// Does what `control` asks.
void apply(const v1::Control& control, Coordinator& coordinator, Instant now);

}  // namespace dmise
