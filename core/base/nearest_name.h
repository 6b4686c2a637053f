#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace dmise {

/// Returns the entry of `names` closest to `word` by edit distance; empty if none is close.
std::string nearest_name(std::string_view word, const std::vector<std::string>& names);

/// Returns ", did you mean NAME?" with that entry, for the end of a message; empty if none is
/// close.
std::string did_you_mean(std::string_view word, const std::vector<std::string>& names);

}  // namespace dmise
