#pragma once
#include <cstdint>

namespace dmise {

struct ProcessMemory {
  std::uint64_t peak_resident_bytes = 0;
  std::uint64_t resident_bytes = 0;
  std::uint64_t private_bytes = 0;  // resident and of no file
};

/// Memory of this process, from /proc.
ProcessMemory process_memory();

/// Time since the start of this process, to 0.01 s.
double process_age_s();

/// CPU time of all threads of this process.
double process_cpu_s();

}  // namespace dmise
