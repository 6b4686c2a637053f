#pragma once

namespace dmise {

/// The paper's all-sky frame (Table 2): every star to V = 9 of the field with its own trail, every
/// sunlit object of a catalogue of 18,470, dark sky, Poisson, written as FITS; no detection. Its
/// time on one thread, the time of its stages, and the most memory that the process takes
/// meanwhile.
void measure_all_sky(bool json);

}  // namespace dmise
