#pragma once
#include <string>
#include <variant>
#include <vector>

#include "core/config/yaml_reader.h"
#include "core/orbit/elements.h"
#include "core/orbit/motion.h"

namespace dmise {

/// How an object of the scenario's own moves: an element set for SGP4, or any other model.
struct MotionConfig {
  std::variant<MotionModel, MeanElements> model;
  std::string oem_path;                    // resolved; empty for other models
  std::vector<std::string> warnings = {};  // see `disproportions_of_orbit`
};

/// Reads one of `two_body`, `oem`, `fixed`, `sgp4`; `start` is the epoch where two_body names none.
/// Throws `ConfigError` `file:line:column: key: reason`, and of an OEM its own line.
MotionConfig read_motion(const YamlValue& value, const Utc& start);

}  // namespace dmise
