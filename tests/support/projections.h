#pragma once
#include <ostream>
#include <string>
#include <vector>

namespace dmise::test {

/// A projection as configuration has it after `projection: `, with coefficients where it has some.
struct ProjectionCase {
  std::string name, yaml;
  double fields_to_deg = 182;  // across the frame; to here a WCS holds it to 0.1 px
  double widest_deg = 182;     // at extreme pointings
};

inline void PrintTo(const ProjectionCase& p, std::ostream* out) { *out << p.name; }

/// One of every row of the table of projections.
inline const std::vector<ProjectionCase> every_projection{
    {"gnomonic", "gnomonic", 168, 160},
    {"equidistant", "equidistant"},
    {"equisolid", "equisolid"},
    {"stereographic", "stereographic"},
    {"kannala_brandt",
     "kannala_brandt, distortion: {k1: -0.013, k2: 0.021, k3: -0.0125, k4: 0.0019}"},
    {"brown_conrady", "brown_conrady, distortion: {k1: -0.1, k2: 0.02, p1: 2e-4, p2: -1e-4}", 60,
     60},
};

}  // namespace dmise::test
