#pragma once
namespace CLI {
class App;
}

namespace dmise {

/// Table 3 of the DMISE-GHOST paper by 200 seeds, and the time of the two-band sequence of whole
/// frames. Returns 0 if the means are within 2 standard errors, the scatter within 20 % of theory,
/// the z-scores 0.9 to 1.1 wide and the sequence within 30 s on two threads.
int bench_paper(bool json);
void add_paper_options(CLI::App& app);

}  // namespace dmise
