#pragma once
#include <functional>
#include <string>

#include "core/products/detection.h"
#include "core/products/truth.h"
#include "core/products/unknown_facts.h"

namespace dmise {

struct FrameReport;

/// ISO 8601 text of a simulation time.
using UtcText = std::function<std::string(SimTime)>;

// One line of JSON each, without the line end, with a fixed order of keys. Times are in nanoseconds
// since the scenario's start and UTC; angles in degrees; units are in the keys. What depends on
// an unknown fact is null. Throws `Error` with the key for a value that is not finite.
std::string to_json(const Detection& detection, const UtcText& utc,
                    const UnknownFacts& unknown = {});
std::string to_json(const FrameReport& report, const UtcText& utc,
                    const UnknownFacts& unknown = {});
std::string to_json(const Truth& truth, const UtcText& utc);

const char* detection_kind_name(DetectionKind kind);
const char* exposure_epoch_name(ExposureEpoch epoch);

}  // namespace dmise
