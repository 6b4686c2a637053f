#pragma once
#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace dmise {

/// Costs of processes at one instant.
struct CostReading {
  double wall_s = 0.0;
  std::int64_t loopback_bytes = 0;  // received by the loopback device of this network namespace
  std::vector<double> cpu_s;        // by process, all threads; 0 if it has ended
};

CostReading read_costs(const std::vector<pid_t>& processes);

/// Moves this process and its future children into a network namespace with only a loopback device,
/// so that its traffic is theirs. False if the system does not allow it. Call before threads start.
bool enter_own_network();

}  // namespace dmise
