#include "core/orbit/sgp4/sgp4_kernel.h"

namespace dmise::avx512 {
using namespace sgp4;
const Kernels sgp4_kernels = {near_blocks, deep_block_at, near_block, deep_block};
}  // namespace dmise::avx512
