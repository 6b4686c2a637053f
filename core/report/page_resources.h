#pragma once
#include <string_view>

namespace dmise {

/// The script and the style of page/.
extern const std::string_view page_script, page_style;

}  // namespace dmise
