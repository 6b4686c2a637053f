#pragma once
#include <functional>
#include <string>

#include "core/products/task.h"

namespace dmise {

/// A line of tasks.jsonl, without its end: keys in the order of core/products/task_fields.h, times
/// in nanoseconds since the scenario's start and as `utc`. Throws `Error` with the key for a value
/// that is not finite.
std::string to_json(const Task& task, const std::function<std::string(SimTime)>& utc);

}  // namespace dmise
