#pragma once
#include <string>
#include <vector>

#include "core/orbit/elements/elements.h"
#include "core/visibility/passes.h"

namespace dmise {

/// Passes of one sensor with references to their context, which must outlive it.
struct PassList {
  const SensorConfig& sensor;
  const Clock& clock;
  const std::vector<MeanElements>& elements;
  const std::vector<Pass>& passes;  // in order of output
  bool tells_excluded = false;      // in a separate column
};

/// Table for display: at most `rows` passes, 0 for all. `has_csv`: passes.csv has the rest.
std::string pass_table(const PassList& list, int rows, bool has_csv);

/// A header line, then one per pass: UTC to 10 ms, degrees, kilometres; empty for missing values
/// (no azimuth in orbit, no sunlit part).
std::string pass_csv(const PassList& list, bool with_header = true);

/// A list as one JSON object per pass, null for missing values.
std::string pass_jsonl(const PassList& list);

/// "LEO", "MEO", "GEO", "HEO" or "far".
const char* orbit_class(const MeanElements& elements);

}  // namespace dmise
