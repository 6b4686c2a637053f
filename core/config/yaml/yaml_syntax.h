#pragma once
#include <yaml-cpp/exceptions.h>

#include <string>

namespace dmise {

/// Returns "file:line:column: not valid YAML: reason" for what the parser refuses in `text`. The
/// parser notices a bracket that is not closed, or a tab, lines later: the place returned is where
/// that begins.
std::string syntax_complaint(const std::string& text, const std::string& file,
                             const YAML::Exception& refusal);

}  // namespace dmise
