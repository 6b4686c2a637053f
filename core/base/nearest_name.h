#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace dmise {

/// Returns the entry of `names` closest to `word` by edit distance; empty if none is close.
std::string nearest_name(std::string_view word, const std::vector<std::string>& names);

}  // namespace dmise
