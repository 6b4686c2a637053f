#include "bench/benches.h"

#include "bench/bench_interpolation.h"
#include "bench/bench_tick.h"

namespace dmise {

std::vector<Bench> benches() {
  return {
      {"interpolation", "error and cost of interpolating between ticks", bench_interpolation},
      {"tick", "lock-step ticks beside the bare ZeroMQ floor", bench_tick},
  };
}

}  // namespace dmise
