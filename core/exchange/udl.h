#pragma once
#include <string>

namespace dmise {

struct ExportRequest;

/// A list of EOObservation records as the Unified Data Library takes them (JSON): degrees,
/// kilometres, GCRF, UTC to the microsecond, dataMode SIMULATED. Magnitudes are of the band that
/// `descriptor` names.
std::string udl_json(const ExportRequest& request);

}  // namespace dmise
