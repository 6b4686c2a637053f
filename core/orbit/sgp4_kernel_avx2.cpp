#include "core/orbit/sgp4_kernel.h"

namespace dmise::sgp4 {
const Kernels kernels_avx2 = {near_blocks, deep_block_at, near_block, deep_block};
}  // namespace dmise::sgp4
