#pragma once
#include <string>

namespace dmise {

/// `value` with a fixed number of decimals, never "-0.000". Throws `Error` if it is not finite.
std::string fixed_text(double value, int decimals);

}  // namespace dmise
