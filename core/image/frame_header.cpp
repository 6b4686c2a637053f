#include "core/image/frame_header.h"

#include <algorithm>
#include <cmath>

namespace dmise {

const char* projection_name(Projection projection) {
  switch (projection) {
    case Projection::gnomonic:
      return "gnomonic";
    case Projection::equidistant:
      return "equidistant";
    case Projection::equisolid:
      return "equisolid";
    case Projection::stereographic:
      return "stereographic";
  }
  return "unknown";
}

std::optional<Projection> projection_named(const std::string& name) {
  for (const auto projection : {Projection::gnomonic, Projection::equidistant,
                                Projection::equisolid, Projection::stereographic})
    if (name == projection_name(projection)) return projection;
  return std::nullopt;
}

}  // namespace dmise
