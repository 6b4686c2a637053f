#pragma once
#include <string>

#include "core/conjunction/encounter.h"

namespace dmise {

struct CdmObject {
  std::string number, name, designator;  // as catalogued; may be empty but for the number
};

/// What a Conjunction Data Message says beside the encounter.
struct CdmFacts {
  std::string created_utc, message_id, closest_utc;  // ISO 8601, without Z
  CdmObject first, second;
  std::string covariance_method = "CALCULATED";  // or DEFAULT: of an age alone
  double probability = 0.0;
};

/// A CCSDS Conjunction Data Message (508.0-B-1) in KVN: states in GCRF at the closest approach,
/// covariances in RTN of each object.
std::string cdm_text(const Encounter& encounter, const CdmFacts& facts);

}  // namespace dmise
