#pragma once
#include <string>

namespace dmise {

struct ExportRequest;

/// CCSDS Orbit Mean-elements Messages (502.0-B-2) in XML, one for each element set of the run's
/// catalogues in their order. Numbers have the digits of the source: 14 significant ones.
std::string omm_text(const ExportRequest& request);

}  // namespace dmise
