#pragma once
#include <string>

namespace dmise {

/// `value` with a fixed number of decimals, never "-0.000". Throws `Error` if it is not finite.
std::string fixed_text(double value, int decimals);

/// The shortest text that reads back to the same bits. Throws `Error` if it is not finite.
std::string exact_text(double value);

}  // namespace dmise
