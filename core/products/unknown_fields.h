#pragma once
#include <string_view>

#include "core/products/unknown_facts.h"

namespace dmise {

/// Whether a field of a detection's or a report's JSON line depends on a fact that is unknown.
bool is_unknown(std::string_view key, const UnknownFacts& unknown);

}  // namespace dmise
