#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace dmise {

/// The one of `names` that is likeliest meant by `word`; empty if none is near.
std::string nearest_name(std::string_view word, const std::vector<std::string>& names);

}  // namespace dmise
