#pragma once
#include <string>
#include <string_view>
#include <vector>

namespace dmise {

/// The one of `names` that is likeliest meant by `word`, whatever its case; of "OSCAR 7 (AO-7)"
/// each of both names counts too. Empty if none is near.
std::string nearest_object(std::string_view word, const std::vector<std::string>& names);

}  // namespace dmise
