#pragma once
#include <string>

namespace dmise {

/// Writes the page of a run, index.html, into its directory, from the products in it alone; stars
/// are marked if the run's catalogue is found from here. `threads`: 0 for one a processor, at
/// most 8. `pixels`: frames can be opened with their pixels, which are read from the FITS files;
/// else with their PNG, which takes no time. Returns the path of the page. Throws `Error`.
std::string write_report(const std::string& directory, bool pixels = true, int threads = 0);

}  // namespace dmise
