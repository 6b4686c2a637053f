#include "core/base/memory.h"

#include <malloc.h>

namespace dmise {

void return_large_blocks() { mallopt(M_MMAP_THRESHOLD, 1 << 18); }

}  // namespace dmise
