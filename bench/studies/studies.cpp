#include "bench/benches.h"
#include "bench/studies/bench_paper.h"
#include "bench/studies/bench_scaling.h"

namespace dmise {

std::vector<Bench> benches() {
  return {
      {"paper", "Table 3 of the DMISE-GHOST paper by 200 seeds, and the sequence of whole frames",
       bench_paper, add_paper_options},
      {"scaling", "cost of 2 to 200 sensor nodes in time-master, broker and links", bench_scaling,
       add_scaling_options},
  };
}

}  // namespace dmise
