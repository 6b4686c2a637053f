#include "nodes/runtime/program/version_text.h"

#include "core/base/numeric/simd_level.h"
#include "dmise_commit.h"

namespace dmise {

std::string version_text(const std::string& program) {
  return program + " " DMISE_VERSION " (commit " DMISE_COMMIT ", " + name(best_simd_level()) + ")";
}

}  // namespace dmise
