#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "bench/effect_trial.h"

namespace dmise {

/// The names of the cameras in the folder of presets, sorted.
std::vector<std::string> shipped_cameras();

/// Draws a place, a time from day's end to night and a pointing for the whole detector of a camera,
/// and measures the grid of its sky at each level and in plans: against the sky itself at pixels
/// some hundredth of a side apart. The trial has the error of the background alone.
SceneTrial try_whole_field(const std::string& camera, int number, std::uint64_t seed,
                           const std::filesystem::path& directory, Threads& threads);

}  // namespace dmise
