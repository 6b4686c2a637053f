#include "core/orbit/sgp4/sgp4_kernel.h"

namespace dmise::sse2 {
using namespace sgp4;
const Kernels sgp4_kernels = {near_blocks, deep_block_at, near_block, deep_block};
}  // namespace dmise::sse2
