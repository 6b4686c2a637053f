#include "core/orbit/sgp4_kernel.h"

namespace dmise::sgp4 {
const Kernels kernels_sse2 = {near_blocks, near_block, deep_block, deep_block_at};
}  // namespace dmise::sgp4
