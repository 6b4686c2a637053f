#pragma once
#include <string>

namespace dmise {

/// Returns "dmise-broker 1.0.0 (commit 1a2b3c4d5e6f, avx512)": name and version of a program, the
/// commit that it was built from, and the instruction set that it uses on this processor.
std::string version_text(const std::string& program);

}  // namespace dmise
