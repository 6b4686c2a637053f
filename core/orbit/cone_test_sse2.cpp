#include "core/orbit/cone_kernel.h"

namespace dmise {
const ConeKernels cone_kernels_sse2 = {present_words, cone_words};
}  // namespace dmise
