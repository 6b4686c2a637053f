#pragma once

namespace CLI {
class App;
}

namespace dmise {

/// Whether planned frames stay within their budgets and bounds of effects hold, over scenes that
/// are drawn at random; and what plans save.
int bench_effects(bool json);
void add_effects_options(CLI::App& app);

}  // namespace dmise
