#pragma once
#include <string>

#include "core/config/scenario_draws.h"

namespace dmise {

/// Digest of everything that determines the samples of a scenario with distributions: its text, the
/// presets and catalogues that its choices name, and the program. It does not depend on the seeds.
/// Throws `ConfigError` for a value at the end of a distribution that is refused.
std::string dataset_digest(const ScenarioDraws& draws);

/// Throws `ConfigError` for products that samples do not have.
void check_output_of_dataset(const Scenario& scenario);

}  // namespace dmise
