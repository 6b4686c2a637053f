#pragma once
#include <string>
#include <vector>

#include "core/orbit/elements.h"
#include "core/visibility/passes.h"

namespace dmise {

/// Passes of one sensor with what their texts need; plain references, alive while used.
struct PassList {
  const SensorConfig& sensor;
  const Clock& clock;
  const std::vector<MeanElements>& elements;
  const std::vector<Pass>& passes;  // in the order in which they are told
};

/// Columns for people: at most `rows` passes, 0 for all.
std::string pass_table(const PassList& list, std::size_t rows);

/// A line of names, then one a pass: UTC to 10 ms, degrees, kilometres; empty where there is
/// nothing to say (no azimuth in orbit, no sunlit part).
std::string pass_csv(const PassList& list, bool with_header = true);

/// The same as one JSON object a pass, null for what is empty.
std::string pass_jsonl(const PassList& list);

/// "LEO", "MEO", "GEO", "HEO" or "far".
const char* orbit_class(const MeanElements& elements);

}  // namespace dmise
