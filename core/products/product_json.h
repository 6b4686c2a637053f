#pragma once
#include <functional>
#include <string>

#include "core/base/files/json_record.h"
#include "core/products/detection.h"
#include "core/products/found_breakup.h"
#include "core/products/frame_report.h"
#include "core/products/kept_orbit.h"
#include "core/products/task.h"
#include "core/products/track.h"
#include "core/products/truth.h"
#include "core/products/unknown_facts.h"

// Products as lines of JSON, both ways, without the line's end. The order of keys is that of
// `visit_fields`. Times are in nanoseconds since the scenario's start and UTC; angles in degrees;
// units are in the keys.
namespace dmise {

/// ISO 8601 text of a simulation time.
using UtcText = std::function<std::string(SimTime)>;

// What depends on an unknown fact is null. Throw `Error` with the key for a value that is not
// finite.
std::string to_json(const Detection& detection, const UtcText& utc,
                    const UnknownFacts& unknown = {});
std::string to_json(const FrameReport& report, const UtcText& utc,
                    const UnknownFacts& unknown = {});
std::string to_json(const Truth& truth, const UtcText& utc);
std::string to_json(const Track& track, const UtcText& utc);
std::string to_json(const Task& task, const UtcText& utc);
std::string to_json(const KeptOrbit& orbit, const UtcText& utc);
std::string to_json(const FoundBreakup& breakup, const UtcText& utc);

// Throw `ConfigError` "FILE:LINE: KEY: reason" for a key that is missing or wrong.
Detection detection_of(const JsonRecord& line);
FrameReport report_of(const JsonRecord& line);
/// Position and velocity are 0 in lines of versions that did not write them.
Truth truth_of(const JsonRecord& line);
Track track_of(const JsonRecord& line);
Task task_of(const JsonRecord& line);
KeptOrbit kept_orbit_of(const JsonRecord& line);
FoundBreakup found_breakup_of(const JsonRecord& line);
/// The object `wcs` of a report.
Wcs wcs_of(const JsonRecord& object);

}  // namespace dmise
