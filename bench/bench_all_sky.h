#pragma once
#include <filesystem>
#include <string>

namespace dmise {

/// The paper's all-sky frame (Table 2): every star to V = 9 in the field with its own trail, every
/// sunlit object of a catalogue of 18,470, dark sky, Poisson, written as FITS; no detection. Prints
/// its time on one thread, the time of its stages, and the peak memory of the process.
void measure_all_sky(bool json);

/// Writes its scenario to `directory`; returns the path, empty without Debian's catalogues.
std::string all_sky_scenario(const std::filesystem::path& directory);

}  // namespace dmise
