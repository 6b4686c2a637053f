#pragma once
#include <string>
#include <string_view>

#include "core/orbit/attitude.h"

namespace dmise {

/// Reads a CSV (optionally gzip) with the header `time_s,w,x,y,z`: seconds since the run's start,
/// increasing, and the quaternion gcrs_from_body with a length in (0.5, 2), which is normalised.
/// Lines that begin with '#' are comments. Throws `ConfigError` `file:line: reason, got "value"`.
TableAttitude read_attitude_table(const std::string& path);
TableAttitude parse_attitude_table(std::string_view text, const std::string& source);

}  // namespace dmise
