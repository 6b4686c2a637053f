#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace dmise {

/// Returns the entry of `names` closest to `word`, ignoring case; for "OSCAR 7 (AO-7)" both names
/// count. Empty if none is close.
std::string nearest_object(std::string_view word, const std::vector<std::string>& names);

}  // namespace dmise
