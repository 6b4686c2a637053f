#pragma once
#include <string>

namespace dmise {

struct ExportRequest;

/// CCSDS Orbit Mean-elements Messages (502.0-B-2) in XML, one for each element set of the run's
/// catalogues in their order, or one for the latest state of each confirmed track, with elements
/// fitted to its orbit and a comment on how well. Numbers have the digits of the source: 14
/// significant ones.
std::string omm_text(const ExportRequest& request);

}  // namespace dmise
