#pragma once
#include <sys/types.h>

#include <cstdint>
#include <optional>
#include <vector>

namespace dmise {

/// What processes had spent at one instant.
struct CostReading {
  double wall_s = 0.0;
  std::int64_t loopback_bytes = 0;  // received by the loopback device of this network namespace
  std::vector<double> cpu_s;        // of each process, all threads; 0 of one that is gone
};

CostReading read_costs(const std::vector<pid_t>& processes);

/// Moves this process and those that it starts from now on into a network of their own, with
/// nothing but a loopback device, so that what passes over it is theirs. False where the system
/// does not allow it. To be called before threads start.
bool enter_own_network();

}  // namespace dmise
