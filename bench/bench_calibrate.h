#pragma once

namespace CLI {
class App;
}

namespace dmise {

/// Measures what effects cost on this machine and keeps it for predictions.
int bench_calibrate(bool json);
void add_calibrate_options(CLI::App& app);

}  // namespace dmise
