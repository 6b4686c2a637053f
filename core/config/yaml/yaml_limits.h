#pragma once
#include <yaml-cpp/mark.h>

#include <cstddef>
#include <string>

namespace dmise {

/// Limits of a YAML file, far above any scenario: one of 10,000 sensors with twenty keys each has
/// 400,000 values.
struct YamlLimits {
  std::size_t bytes = 16u << 20;
  std::size_t values = 500'000;  // keys, values, lists and mappings, aliases expanded
  std::size_t depth = 64;        // nesting of lists and mappings
};

/// "FILE:LINE:COLUMN", or "FILE" without a mark.
std::string place_of(const std::string& file, const YAML::Mark& mark);

/// Parses `text` without building a tree and throws `ConfigError` "file:line:column: reason" if it
/// is not YAML, exceeds the limits, contains itself by an alias or has a second document. Text that
/// passes gives a finite tree of bounded memory.
void check_yaml_limits(const std::string& text, const std::string& file,
                       const YamlLimits& limits = {});

}  // namespace dmise
