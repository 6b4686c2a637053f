#include "bench/benches.h"

#include "bench/bench_tick.h"

namespace dmise {

std::vector<Bench> benches() {
  return {
      {"tick", "lock-step ticks beside the bare ZeroMQ floor", bench_tick},
  };
}

}  // namespace dmise
