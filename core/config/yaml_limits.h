#pragma once
#include <cstddef>
#include <string>

namespace dmise {

/// What a YAML file may cost, far above any scenario: one of 10,000 sensors with twenty keys each
/// has 400,000 values.
struct YamlLimits {
  std::size_t bytes = 16u << 20;
  std::size_t values =
      500'000;             // keys, values, lists and mappings, each alias as all it stands for
  std::size_t depth = 64;  // of lists and mappings in one another
};

/// Reads `text` without keeping it and throws `ConfigError` "file:line:column: reason" where it is
/// no YAML, goes beyond the limits, holds itself by an alias or has a second document: a tree made
/// of what passes is finite, and its memory bounded.
void check_yaml_limits(const std::string& text, const std::string& file,
                       const YamlLimits& limits = {});

}  // namespace dmise
